#include "stereo/edit.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "stereo/anchor_areas.h"
#include "stereo/edit_classes.h"
#include "stereo/edit_shape.h"
#include "stereo/map_columns.h"
#include "stereo/matching.h"
#include "stereo/target_gradient.h"

namespace obscura {
namespace {

/// Terms of single pixels or sets count reduction^2 pixels of the full picture each.
double area_weight(const MiddleView& view) {
    return static_cast<double>(view.reduction) * view.reduction;
}

/// The disparities that conflicts leave to a pixel. Only limits with a weight are here.
struct Allowed {
    double nearest_px, farthest_px;
    double clamped(double d) const { return std::min(std::max(d, farthest_px), nearest_px); }
};

/// The side of the picture leaves as much disparity as its distance in pixels, or what was there before.
double window_limit(const EditParams& params, double distance, double original) {
    return params.window_inherited ? distance : std::max(distance, original);
}

Allowed allowed(const EditParams& params, double distance, double original) {
    Allowed a{1e30, -1e30};
    if (params.comfort_weight > 0) a = {params.comfort.nearest_px, params.comfort.farthest_px};
    if (params.window_weight > 0)
        a.nearest_px = std::min(a.nearest_px, window_limit(params, distance, original));
    return a;
}

/// Anchors of edits and of conflicts of one pixel; D~ is brought to what conflicts allow.
void anchor_pixel(const EditParams& params, const ClassShape& shape, double distance, double area,
                  std::size_t i, DisparitySystem& s) {
    const auto original = static_cast<double>(s.original.pixels[i]);
    const auto edited = static_cast<double>(s.start.pixels[i]);
    const Allowed range = allowed(params, distance, original);

    // All anchors of a pixel obey the same limits, so none pulls back into a conflict.
    const double own = params.anchor_weight * shape.anchor_weight;
    const double own_value = range.clamped(rounded(shape, original) + shape.anchor_offset_px);
    double forced = 0;
    if (params.comfort_weight > 0 &&
        (edited > params.comfort.nearest_px || edited < params.comfort.farthest_px))
        forced += params.comfort_weight;
    if (params.window_weight > 0 && edited > window_limit(params, distance, original))
        forced += params.window_weight;
    if (own + forced == 0) return;

    const double limit = range.clamped(edited);
    s.anchor_weight.pixels[i] = static_cast<float>(area * (own + forced));
    s.anchor_value.pixels[i] = static_cast<float>(
        forced == 0 ? own_value : own_value + (limit - own_value) * (forced / (own + forced)));
    if (forced > 0) s.start.pixels[i] = static_cast<float>(limit);
}

void write_anchors(const MiddleView& view, const ClassMap& map, const std::vector<ClassShape>& shapes,
                   const EditParams& params, const Exec& exec, DisparitySystem& system) {
    const int width = view.width();
    std::vector<double> distance;
    distance.reserve(static_cast<std::size_t>(width));
    for (int x = 0; x < width; ++x)
        distance.push_back(border_distance(view, x));
    parallel_blocks(static_cast<std::size_t>(view.height()), 16, exec,
                    [&](std::size_t begin, std::size_t end) {
                        for (std::size_t i = begin * distance.size(); i < end * distance.size(); ++i)
                            if (const std::uint32_t c = map.of.pixels[i]; c != no_class)
                                anchor_pixel(params, shapes[c], distance[i % distance.size()],
                                             area_weight(view), i, system);
                    });
}

bool is_seen(const ClassMap& map, const EditTarget& target) {
    const std::vector<std::uint8_t> covered = covered_classes(map, target);
    return std::find(covered.begin(), covered.end(), 1) != covered.end();
}

/// Edits whose targets are out of sight.
std::vector<EditNotice> unseen_targets(const ClassMap& map, const std::vector<const StereoEdit*>& edits) {
    std::vector<EditNotice> notices;
    const auto look = [&](const StereoEdit& edit, const EditTarget& target) {
        const bool asked = !target.objects.empty() || !target.materials.empty();
        if (asked && !is_seen(map, target)) notices.push_back({edit.name, "its target is not seen"});
    };
    for (const StereoEdit* edit : edits) {
        if (const auto* r = std::get_if<RoundnessEdit>(&edit->what)) look(*edit, r->target);
        if (const auto* a = std::get_if<AnchorEdit>(&edit->what)) look(*edit, a->target);
        if (const auto* i = std::get_if<InterfaceEdit>(&edit->what)) {
            look(*edit, i->first);
            look(*edit, i->second);
        }
    }
    return notices;
}

void check(const MiddleView& view, const EditParams& params) {
    const std::size_t size = view.disparity.pixels.size();
    CHECK(view.object.pixels.size() == size &&
          (view.material.pixels.empty() || view.material.pixels.size() == size) && view.reduction >= 1);
    CHECK(params.gradient_weight > 0 && params.anchor_weight >= 0 && params.match_weight >= 0 &&
          params.epsilon > 0 && params.comfort_weight >= 0 && params.window_weight >= 0);
}

}  // namespace

EditedSystem edited_system(const MiddleView& view, const std::vector<StereoEdit>& edits,
                           const EditParams& params, const std::vector<std::string>& object_names,
                           const Exec& exec) {
    check(view, params);
    EditedSystem result;
    DisparitySystem& system = result.system;
    system = unedited_system(view.disparity, valid_pixels(view), exec);
    system.gradient_weight = static_cast<float>(params.gradient_weight);
    system.epsilon = static_cast<float>(params.epsilon * area_weight(view));

    // What the artist asks for, class by class, and D~ of it.
    const std::vector<const StereoEdit*> order = edits_in_order(edits);
    const ClassMap map = classify(view, system.valid, exec);
    const std::vector<ClassShape> shapes = shape_classes(map, system.original, order);
    result.notices = unseen_targets(map, order);
    if (params.match_weight > 0) system.sets = matching_sets(view, system.valid, order, result.notices);
    system.start = edited_disparity(map, system.original, shapes, exec);
    if (params.match_weight > 0) hold_sources(view, system.valid, system.start, order, system.sets);
    move_members(system.sets, system.start);

    // What is wrong with that.
    Conflicts found =
        find_conflicts(view, system.start, {params.comfort, params.meaningful_px}, object_names, exec);
    result.conflicts = std::move(found.list);
    result.conflict_pixels = std::move(found.pixels);

    // Terms. Anchors bring D~ to what conflicts allow, so gradients come after them.
    write_anchors(view, map, shapes, params, exec, system);
    system.anchors = anchor_areas(map, shapes, order, params, system);
    write_target_gradients(view, map, shapes, order, params, exec, system);
    for (MatchingSet& set : system.sets)
        set.weight =
            static_cast<float>(params.match_weight * area_weight(view) * static_cast<double>(set.weight));
    return result;
}

DisparityMap edited_disparity(const MiddleView& view, const std::vector<StereoEdit>& edits,
                              const Exec& exec) {
    const Image<std::uint8_t> valid = valid_pixels(view);
    const std::vector<const StereoEdit*> order = edits_in_order(edits);
    const ClassMap map = classify(view, valid, exec);
    std::vector<EditNotice> notices;
    DisparityMap edited =
        edited_disparity(map, view.disparity, shape_classes(map, view.disparity, order), exec);
    move_members(matching_sets(view, valid, order, notices), edited);
    return edited;
}

}  // namespace obscura
