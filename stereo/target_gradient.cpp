#include "stereo/target_gradient.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "stereo/conflict.h"
#include "stereo/map_columns.h"

namespace obscura {
namespace {

/// An interface edit with its targets settled per class.
struct Border {
    std::vector<std::uint8_t> first, second;  ///< both empty: a mask for all pairs
    const Image<float>* mask = nullptr;
    double share = 1;
    bool keep = true;
    bool between(std::uint32_t p, std::uint32_t q) const {
        return (first[p] != 0 && second[q] != 0) || (first[q] != 0 && second[p] != 0);
    }
};

struct Rules {
    const MiddleView& view;
    const ClassMap& map;
    const std::vector<ClassShape>& shapes;
    const EditParams& params;
    std::vector<Border> borders;
    std::vector<std::vector<std::uint8_t>> together;  ///< classes of a thing made of several objects
    bool masks_inside = false;                        ///< some mask is for all pairs
};

bool empty(const EditTarget& target) {
    return target.objects.empty() && target.materials.empty();
}

Rules rules_of(const MiddleView& view, const ClassMap& map, const std::vector<ClassShape>& shapes,
               const std::vector<const StereoEdit*>& edits, const EditParams& params) {
    Rules rules{view, map, shapes, params, {}, {}, false};
    for (const StereoEdit* edit : edits) {
        if (const auto* r = std::get_if<RoundnessEdit>(&edit->what); r != nullptr && r->together)
            rules.together.push_back(covered_classes(map, r->target));
        const auto* interface = std::get_if<InterfaceEdit>(&edit->what);
        if (interface == nullptr) continue;
        Border b;
        b.share = share_of(*edit);
        b.keep = interface->keep;
        if (!interface->mask.pixels.empty()) b.mask = &interface->mask;
        if (empty(interface->first) && empty(interface->second)) {
            if (b.mask == nullptr) continue;
            rules.masks_inside = rules.masks_inside || b.keep;
        } else {
            const std::vector<std::uint8_t> any(map.classes.size(), 1);
            b.first = empty(interface->first) ? any : covered_classes(map, interface->first);
            b.second = empty(interface->second) ? any : covered_classes(map, interface->second);
        }
        rules.borders.push_back(std::move(b));
    }
    return rules;
}

/// Pixels p = (x, y) and q = (x + dx, y + dy), neighbours.
struct Pair {
    int x, y, dx, dy;
};

/// The mask, stretched to the picture, at a pixel of the map: bilinear. In the margins, of the picture's
/// edge.
double mask_at(const MiddleView& view, const Image<float>& mask, int x, int y) {
    const auto sample = [&](int i, int j) {
        return static_cast<double>(mask(std::clamp(i, 0, mask.width - 1), std::clamp(j, 0, mask.height - 1)));
    };
    const double u = picture_x(view, x) * mask.width / view.picture_width - 0.5;
    const double v = picture_y(view, y) * mask.height / view.picture_height - 0.5;
    const double i = std::floor(std::clamp(u, -1.0, static_cast<double>(mask.width)));
    const double j = std::floor(std::clamp(v, -1.0, static_cast<double>(mask.height)));
    const double s = std::clamp(u - i, 0.0, 1.0), t = std::clamp(v - j, 0.0, 1.0);
    const int i0 = static_cast<int>(i), j0 = static_cast<int>(j);
    const double top = sample(i0, j0) + s * (sample(i0 + 1, j0) - sample(i0, j0));
    const double low = sample(i0, j0 + 1) + s * (sample(i0 + 1, j0 + 1) - sample(i0, j0 + 1));
    return std::clamp(top + t * (low - top), 0.0, 1.0);
}

/// A pair is under a mask as far as both its pixels are.
double mask_of(const Rules& rules, const Border& b, const Pair& at) {
    if (b.mask == nullptr) return 1;
    return std::min(mask_at(rules.view, *b.mask, at.x, at.y),
                    mask_at(rules.view, *b.mask, at.x + at.dx, at.y + at.dy));
}

/// How far a pair keeps the original gradient, in [0, 1], when it would otherwise keep `share` of it.
/// Whatever keeps prevails over what lets go; shares of one kind combine as independent ones do.
double kept_share(const Rules& rules, const Pair& at, std::uint32_t p, std::uint32_t q, bool border,
                  double share) {
    double lost = 1;
    for (const Border& b : rules.borders) {
        const bool here = b.first.empty() ? (b.keep || border) : (border && b.between(p, q));
        if (!here) continue;
        const double part = b.share * mask_of(rules, b, at);
        (b.keep ? lost : share) *= 1 - part;
    }
    return 1 - (1 - share) * lost;
}

bool one_thing(const Rules& rules, std::uint32_t p, std::uint32_t q) {
    if (rules.map.classes[p].object == rules.map.classes[q].object) return true;
    return std::any_of(rules.together.begin(), rules.together.end(),
                       [&](const auto& thing) { return thing[p] != 0 && thing[q] != 0; });
}

/// Largest horizontal gradient that is asked for where a larger one would fold: some way below, so that the
/// solver's compromises do not fold either.
double limited_step(int reduction) {
    return 0.95 * fold_step(reduction);
}

float inside_gradient(const Rules& rules, const Pair& at, std::uint32_t p, std::uint32_t q, float original) {
    const double factor =
        p == q ? rules.shapes[p].factor : 0.5 * (rules.shapes[p].factor + rules.shapes[q].factor);
    const double keep = rules.masks_inside ? kept_share(rules, at, p, q, false, 0) : 0;
    double g = static_cast<double>(original) * (factor + keep * (1 - factor));
    const double fold = fold_step(rules.view.reduction);
    if (rules.params.limit_folds && at.dx != 0 && std::abs(g) >= fold &&
        std::abs(static_cast<double>(original)) < fold) {
        // Never below what the original has.
        const double most =
            std::max(limited_step(rules.view.reduction), std::abs(static_cast<double>(original)));
        g = std::copysign(most, g);
    }
    return static_cast<float>(g);
}

float border_gradient(const Rules& rules, const Pair& at, std::uint32_t p, std::uint32_t q, float original,
                      float edited) {
    const double usual = rules.params.interfaces == InterfaceGradients::original ? 1 : 0;
    const double keep = rules.borders.empty() ? usual : kept_share(rules, at, p, q, true, usual);
    const auto from = static_cast<double>(original), to = static_cast<double>(edited);
    const double g = keep == 1 ? from : to + keep * (from - to);
    const bool reset = rules.params.reset_inversions && inverted(from, g, rules.params.meaningful_px);
    return reset ? original : static_cast<float>(g);
}

void write_row(const Rules& rules, int y, int dx, int dy, DisparitySystem& system) {
    Image<float>& gradient = dx != 0 ? system.gradient_x : system.gradient_y;
    for (int x = 0; x + dx < system.width(); ++x) {
        const std::uint32_t p = rules.map.of(x, y), q = rules.map.of(x + dx, y + dy);
        if (p == no_class || q == no_class) continue;
        const Pair at{x, y, dx, dy};
        const float original = system.original(x + dx, y + dy) - system.original(x, y);
        gradient(x, y) = one_thing(rules, p, q)
                             ? inside_gradient(rules, at, p, q, original)
                             : border_gradient(rules, at, p, q, original,
                                               system.start(x + dx, y + dy) - system.start(x, y));
    }
}

}  // namespace

void write_target_gradients(const MiddleView& view, const ClassMap& map,
                            const std::vector<ClassShape>& shapes,
                            const std::vector<const StereoEdit*>& edits, const EditParams& params,
                            const Exec& exec, DisparitySystem& system) {
    const Rules rules = rules_of(view, map, shapes, edits, params);
    parallel_blocks(static_cast<std::size_t>(system.height()), 8, exec,
                    [&](std::size_t begin, std::size_t end) {
                        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                            write_row(rules, y, 1, 0, system);
                            if (y + 1 < system.height()) write_row(rules, y, 0, 1, system);
                        }
                    });
}

}  // namespace obscura
