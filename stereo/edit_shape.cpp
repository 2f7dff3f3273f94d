#include "stereo/edit_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"

namespace obscura {
namespace {

/// Everything that an edit says, as numbers that can be compared.
struct EditKey {
    std::string name;
    std::size_t kind = 0;
    std::vector<double> numbers;
    std::vector<std::uint32_t> ids;
    auto tie() const { return std::tie(name, kind, numbers, ids); }
};

void put(std::vector<std::uint32_t>& ids, const EditTarget& target) {
    for (const auto* list : {&target.objects, &target.materials}) {
        std::vector<std::uint32_t> sorted = *list;
        std::sort(sorted.begin(), sorted.end());
        ids.push_back(static_cast<std::uint32_t>(sorted.size()));
        ids.insert(ids.end(), sorted.begin(), sorted.end());
    }
}

EditKey key_of(const StereoEdit& edit) {
    EditKey key{edit.name, edit.what.index(), {edit.weight}, {}};
    if (const auto* r = std::get_if<RoundnessEdit>(&edit.what)) {
        put(key.ids, r->target);
        key.numbers.insert(key.numbers.end(), {r->roundness, r->together ? 1.0 : 0.0});
    } else if (const auto* a = std::get_if<AnchorEdit>(&edit.what)) {
        put(key.ids, a->target);
        key.numbers.push_back(a->offset_px);
    } else if (const auto* i = std::get_if<InterfaceEdit>(&edit.what)) {
        put(key.ids, i->first);
        put(key.ids, i->second);
        key.numbers.push_back(i->keep ? 1.0 : 0.0);
        const std::uint64_t hash =
            Hasher{}.value(i->mask.width).value(i->mask.height).values(i->mask.pixels).state;
        key.ids.push_back(static_cast<std::uint32_t>(hash));
        key.ids.push_back(static_cast<std::uint32_t>(hash >> 32));
    } else if (const auto* m = std::get_if<MatchEdit>(&edit.what)) {
        key.numbers.insert(key.numbers.end(),
                           {m->source_px.x, m->source_px.y, m->destination_px.x, m->destination_px.y,
                            m->offset_px, m->radius_px, m->any_object ? 1.0 : 0.0});
    }
    for (const double number : key.numbers)
        CHECK(std::isfinite(number), fmt::format("a number of edit \"{}\"", edit.name));
    return key;
}

/// The groups of classes that one roundness edit gives a centre of their own.
std::vector<std::vector<std::uint32_t>> groups_of(const ClassMap& map, const RoundnessEdit& edit) {
    const std::vector<std::uint8_t> covered = covered_classes(map, edit.target);
    std::vector<std::vector<std::uint32_t>> groups;
    for (std::uint32_t c = 0; c < covered.size(); ++c) {
        if (covered[c] == 0) continue;
        // Classes of one object follow each other.
        const bool same = !groups.empty() && (edit.together || map.classes[groups.back().back()].object ==
                                                                   map.classes[c].object);
        if (!same) groups.emplace_back();
        groups.back().push_back(c);
    }
    return groups;
}

void add_roundness(const ClassMap& map, const DisparityMap& disparity,
                   const std::vector<const StereoEdit*>& edits, std::vector<ClassShape>& shapes) {
    std::vector<std::vector<std::uint32_t>> groups;
    std::vector<const StereoEdit*> edit_of;
    for (const StereoEdit* edit : edits) {
        const auto* r = std::get_if<RoundnessEdit>(&edit->what);
        if (r == nullptr || r->roundness == 1) continue;
        CHECK(r->roundness >= 0, fmt::format("roundness {} of \"{}\"", r->roundness, edit->name));
        for (std::vector<std::uint32_t>& group : groups_of(map, *r)) {
            groups.push_back(std::move(group));
            edit_of.push_back(edit);
        }
    }
    const std::vector<double> centre = centres(map, disparity, groups);

    // One centre per class: the mean of its edits' centres by their shares. They differ only when edits cover
    // different parts of one object.
    std::vector<double> weight(shapes.size(), 0);
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const double share = share_of(*edit_of[g]);
        const double roundness = std::get<RoundnessEdit>(edit_of[g]->what).roundness;
        for (const std::uint32_t c : groups[g]) {
            ClassShape& s = shapes[c];
            s.factor *= 1 + (roundness - 1) * share;
            weight[c] += share;
            s.centre_px += (centre[g] - s.centre_px) * (share / weight[c]);
        }
    }
}

void add_anchors(const ClassMap& map, const std::vector<const StereoEdit*>& edits,
                 std::vector<ClassShape>& shapes) {
    for (const StereoEdit* edit : edits) {
        const auto* anchor = std::get_if<AnchorEdit>(&edit->what);
        if (anchor == nullptr) continue;
        const std::vector<std::uint8_t> covered = covered_classes(map, anchor->target);
        for (std::size_t c = 0; c < covered.size(); ++c) {
            if (covered[c] == 0) continue;
            ClassShape& s = shapes[c];
            s.anchor_weight += edit->weight;
            s.anchor_offset_px += (anchor->offset_px - s.anchor_offset_px) * (edit->weight / s.anchor_weight);
        }
    }
    for (ClassShape& s : shapes)
        s.lift_px = std::min(1.0, s.anchor_weight) * s.anchor_offset_px;
}

}  // namespace

double share_of(const StereoEdit& edit) {
    return std::min(1.0, edit.weight);
}

std::vector<const StereoEdit*> edits_in_order(const std::vector<StereoEdit>& edits) {
    std::vector<std::pair<EditKey, const StereoEdit*>> keyed;
    for (const StereoEdit& edit : edits) {
        CHECK(edit.weight >= 0, fmt::format("weight {} of edit \"{}\"", edit.weight, edit.name));
        if (edit.weight > 0) keyed.emplace_back(key_of(edit), &edit);
    }
    std::stable_sort(keyed.begin(), keyed.end(),
                     [](const auto& a, const auto& b) { return a.first.tie() < b.first.tie(); });
    std::vector<const StereoEdit*> order;
    order.reserve(keyed.size());
    for (const auto& [key, edit] : keyed)
        order.push_back(edit);
    return order;
}

std::vector<ClassShape> shape_classes(const ClassMap& map, const DisparityMap& disparity,
                                      const std::vector<const StereoEdit*>& edits) {
    std::vector<ClassShape> shapes(map.classes.size());
    add_roundness(map, disparity, edits, shapes);
    add_anchors(map, edits, shapes);
    return shapes;
}

DisparityMap edited_disparity(const ClassMap& map, const DisparityMap& disparity,
                              const std::vector<ClassShape>& shapes, const Exec& exec) {
    DisparityMap edited = disparity;
    parallel_blocks(edited.pixels.size(), 1 << 15, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (map.of.pixels[i] == no_class) continue;
            const ClassShape& s = shapes[map.of.pixels[i]];
            if (s.factor == 1 && s.lift_px == 0) continue;
            edited.pixels[i] =
                static_cast<float>(rounded(s, static_cast<double>(disparity.pixels[i])) + s.lift_px);
        }
    });
    return edited;
}

}  // namespace obscura
