#include "app/frame/frame_glare.h"

#include <algorithm>
#include <utility>

#include "app/frame/channels.h"
#include "app/frame/memory.h"

namespace obscura {
namespace {

template <class Pixels>
void crop_channel(const Region& crop, Pixels& channel) {
    if (channel.width == 0) return;
    Pixels part(crop.width, crop.height);
    const auto from = std::as_const(channel).view().crop(crop.x0, crop.y0, crop.width, crop.height);
    const auto to = part.view();
    for (int y = 0; y < crop.height; ++y)
        std::copy_n(from.row(y), crop.width, to.row(y));
    channel = std::move(part);
}

}  // namespace

void check_bright_pixels(const Scene& scene, std::int64_t bright_px, const FrameOptions& channels) {
    check_memory(estimate_memory(scene, {.lights = {}, .bright_px = bright_px, .channels = channels}),
                 scene.limits, "the frame's glare");
}

void add_frame_glare(const Scene& scene, const FrameOptions& options, const Exec& exec,
                     std::optional<KeptPsf>& kept, Frame& frame) {
    if (!scene.optics.enabled) return;
    GlareCall call;
    call.progress = options.progress;
    call.cancel = options.cancel;
    call.check_bright = [&](std::int64_t bright_px) { check_bright_pixels(scene, bright_px, options); };
    call.free_bytes = [&] {
        return (scene.limits.memory_mib << 20) -
               estimate_memory(scene, {.lights = {}, .bright_px = {}, .channels = options}).total();
    };
    LitPicture picture;
    picture.x0 = frame.x0;
    picture.y0 = frame.y0;
    picture.radiance = frame.radiance.view();
    picture.depth_m = frame.depth_m.view();
    picture.object = frame.object.view();
    picture.shift_px = frame.shift_px.view();
    picture.lens_offset_m = frame.lens_offset_m;
    frame.stats.glare = add_glare(scene, call, exec, kept, picture);
    if (!frame.stats.glare) frame.complete = false;
}

void crop_frame(const Region& crop, Frame& frame) {
    if (crop.width == frame.width && crop.height == frame.height) return;
    const Region part{crop.x0 - frame.x0, crop.y0 - frame.y0, crop.width, crop.height};
    crop_channel(part, frame.radiance);
    for_each_channel([&](const auto& row) {
        if (row.by_tiles) crop_channel(part, frame.*row.pixels);
    });
    frame.x0 = crop.x0;
    frame.y0 = crop.y0;
    frame.width = crop.width;
    frame.height = crop.height;
}

}  // namespace obscura
