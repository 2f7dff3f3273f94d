#include "app/report/render_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/frame/shadow_text.h"
#include "app/frame/sun_hours_text.h"
#include "core/count_text.h"
#include "core/edges.h"

namespace obscura {
namespace {

std::string stages_text(const FrameReport& report) {
    const FrameStats& s = report.stats;
    std::string out = fmt::format(
        "  surfaces {:.3f} s, setup {:.3f} s, shadow maps {:.3f} s ({}), tiles {:.3f} s, files {:.3f} s\n",
        s.surface_s, s.setup_s, s.shadow_s, s.shadow_maps, s.tiles_s, report.write_s);
    out += fmt::format("  {}, {} in view, {}, {} of them on a surface; {} MiB at most so far\n",
                       count_text(s.triangles, "triangle"), s.records, count_text(s.samples, "sample"),
                       s.covered_samples, peak_resident_bytes() >> 20);
    if (s.resolution_s + s.needed_s > 0.0005) {
        out += fmt::format("  of shadow maps: resolutions {:.3f} s, finding what is looked up {:.3f} s\n",
                           s.resolution_s, s.needed_s);
    }
    if (s.sky_s > 0.0005)
        out += fmt::format("  of shadow maps: the sky, and what surfaces send on {:.3f} s\n", s.sky_s);
    for (const LightShadowStats& light : s.lights)
        out += shadow_text(light);
    return out;
}

std::string glare_text(const GlareStats& s) {
    std::string out =
        fmt::format("  glare {:.3f} s, of it patterns {:.3f} s: {}\n", s.total_s, s.psf_s, s.reason);
    if (s.sources == 0) return out;
    const std::string margin =
        s.margin_px > 0 ? fmt::format(" with its margin of {}", count_text(s.margin_px, "pixel")) : "";
    return out + fmt::format("  {:.2f} % of their light left its pixel, {:.2f} % the picture{}; {}\n",
                             100 * s.spread, 100 * s.lost, margin, count_text(s.wavelengths, "wavelength"));
}

}  // namespace

std::string plan_text(const RenderReport& report, std::size_t frames) {
    const RunReport& run = report.run;
    const MemoryEstimate& m = report.memory;
    return fmt::format("{}: {}, {} x {} pixels, {} each, {} on {}\n", run.scene, count_text(frames, "frame"),
                       run.width, run.height, count_text(run.samples, "sample"), isa_name(run.exec.isa),
                       count_text(thread_count(run.exec), "thread")) +
           fmt::format(
               "loaded in {:.2f} s; memory about {:.0f} of {} MiB: meshes {:.0f}, textures {:.0f}, "
               "shadow maps {:.0f}, frame {:.0f}\n",
               run.load_s, mib(m.total()), run.limit_mib, mib(m.meshes), mib(m.textures), mib(m.shadow_maps),
               mib(m.frame));
}

std::string frame_text(const FrameReport& report, int verbosity) {
    std::string files;
    for (const WrittenFile& file : report.files) {
        files += (files.empty() ? "" : ", ") + file.file;
        if (!file.depth) continue;
        files += fmt::format(" (0 = {} m, {} = {} m)", file.depth->nearest_m, farthest_code,
                             file.depth->farthest_m);
    }
    std::string out =
        fmt::format("frame {} in {:.2f} s: {}\n", report.frame, report.stats.total_s + report.write_s, files);
    if (verbosity > 0) out += stages_text(report);
    if (report.stats.sun_hours) out += sun_hours_text(*report.stats.sun_hours, verbosity);
    if (verbosity > 0 && report.stats.glare) out += glare_text(*report.stats.glare);
    return out;
}

std::vector<std::string> scene_notes(const Scene& scene, int frame) {
    std::vector<std::string> notes = scene.notes;
    const Mesh& mesh = scene.mesh;
    const bool solid = std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
        return !is_degenerate(mesh.positions[t.v[0]], mesh.positions[t.v[1]], mesh.positions[t.v[2]]);
    });
    if (!solid) notes.emplace_back("no mesh has a triangle with an area; only the sky is seen");
    for (const auto& [light, shadow] : scene.lights) {
        if (light.below_horizon)
            notes.push_back(fmt::format("light '{}' is below the horizon in frame {} and sheds no light",
                                        light.id, frame));
    }
    return notes;
}

}  // namespace obscura
