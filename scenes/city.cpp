#include "scenes/city.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/num.h"
#include "scenes/city_building.h"
#include "scenes/city_plan.h"
#include "scenes/random.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

using namespace city_slot;

std::vector<Material> slots() {
    std::vector<Material> m{material_slot("asphalt", 112, 110, 108, 0.9f),
                            material_slot("kerb", 168, 164, 156, 0.85f),
                            material_slot("sidewalk", 150, 146, 138, 0.9f),
                            material_slot("lawn", 92, 116, 62, 1.0f),
                            material_slot("setts", 126, 120, 114, 0.85f),
                            material_slot("facade_sand", 222, 202, 168, 0.9f),
                            material_slot("facade_brick", 176, 112, 88, 0.9f),
                            material_slot("facade_rose", 214, 164, 140, 0.9f),
                            material_slot("facade_white", 222, 216, 204, 0.85f),
                            material_slot("facade_grey", 168, 166, 160, 0.85f),
                            material_slot("facade_ochre", 208, 178, 130, 0.9f),
                            material_slot("trim", 232, 224, 206, 0.8f),
                            material_slot("pane", 34, 44, 56, 0.08f),
                            material_slot("pane_lit", 60, 56, 48, 0.1f),
                            material_slot("roof_tile", 160, 102, 80, 0.85f),
                            material_slot("roof_slate", 84, 90, 98, 0.6f),
                            material_slot("roof_flat", 120, 116, 110, 0.95f),
                            material_slot("metal", 120, 124, 126, 0.4f),
                            material_slot("wood", 128, 94, 64, 0.9f),
                            material_slot("bark", 92, 76, 60, 0.95f),
                            material_slot("leaf", 82, 112, 50, 0.7f)};
    CHECK(m.size() == city_slot::count);
    m[metal].metallic = 0.7f;
    return m;
}

/// Slab of asphalt; per block a kerb, the sidewalk on it, and lawn or paving at its heart.
Mesh ground(const CityPlan& plan) {
    Mesh m;
    const double e = 0.5 * plan.extent_m;
    add_part(m, box({-e, -1, -e}, {e, 0, e}), {}, asphalt);
    for (const CityBlock& block : plan.blocks) {
        const CityRect a = block.area, h = block.heart;
        add_part(m, box({a.x0, -0.5, a.z0}, {a.x1, 0.14, a.z1}), {}, kerb);
        add_part(m, box({a.x0 + 0.25, -0.4, a.z0 + 0.25}, {a.x1 - 0.25, 0.15, a.z1 - 0.25}), {}, sidewalk);
        if (h.x1 > h.x0) add_part(m, box({h.x0, -0.3, h.z0}, {h.x1, 0.2, h.z1}), {}, lawn);
    }
    return m;
}

/// What is being built: the plan and, per item, its present level and mesh.
struct Site {
    CityPlan plan;
    Mesh ground;
    std::vector<Mesh> built;
    std::int64_t triangles = 0;
};

std::int64_t count_of(const Mesh& m) {
    return static_cast<std::int64_t>(m.triangles.size());
}

Site bare_site(double extent_m, double scale, std::uint64_t seed) {
    Site site;
    site.plan = plan_city(extent_m, scale, seed);
    site.ground = ground(site.plan);
    site.triangles = count_of(site.ground);
    for (const CityItem& item : site.plan.items) {
        site.built.push_back(build_city_item(item, 0));
        site.triangles += count_of(site.built.back());
    }
    return site;
}

/// Raises items one level at a time, in an order shuffled anew for each level, as far as the budget goes.
void refine(Site& site, std::int64_t budget, Random random) {
    std::vector<std::size_t> order(site.built.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = i;
    for (int level = 1; level < city_levels; ++level) {
        for (std::size_t i = order.size(); i > 1; --i) {
            std::swap(order[i - 1], order[static_cast<std::size_t>(random.index(static_cast<int>(i)))]);
        }
        // Towers stand out: they come first.
        std::stable_partition(order.begin(), order.end(),
                              [&](std::size_t i) { return site.plan.items[i].kind == CityItemKind::tower; });
        int refused = 0;
        for (const std::size_t i : order) {
            Mesh finer = build_city_item(site.plan.items[i], level);
            const std::int64_t more = count_of(finer) - count_of(site.built[i]);
            if (site.triangles + more > budget) {
                if (++refused > 40) break;  // the budget is spent but for crumbs
                continue;
            }
            site.triangles += more;
            site.built[i] = std::move(finer);
        }
        if (refused > 0) return;
    }
}

/// Spends what is left on setts: closed stones of 12 triangles, in courses on the asphalt between the blocks.
void pave(Site& site, std::int64_t budget, Random random) {
    const std::int64_t stones = (budget - site.triangles) / 12;
    if (stones < 1) return;
    const double e = 0.5 * site.plan.extent_m;
    double streets = 4 * e * e;
    for (const CityBlock& b : site.plan.blocks)
        streets -= (b.area.x1 - b.area.x0) * (b.area.z1 - b.area.z0);
    const double pitch = std::clamp(std::sqrt(0.97 * streets / static_cast<double>(stones)), 0.02, 0.6);
    std::int64_t laid = 0;
    const auto on_block = [&](double x, double z) {
        return std::any_of(site.plan.blocks.begin(), site.plan.blocks.end(), [&](const CityBlock& b) {
            return x > b.area.x0 - pitch && x < b.area.x1 + pitch && z > b.area.z0 - pitch &&
                   z < b.area.z1 + pitch;
        });
    };
    const int courses = static_cast<int>(2 * e / pitch) - 1;
    for (int j = 0; j < courses && laid < stones; ++j) {
        for (int i = 0; i < courses && laid < stones; ++i) {
            const double x = -e + (i + 0.75 + 0.5 * (j % 2)) * pitch, z = -e + (j + 1) * pitch,
                         h = 0.46 * pitch;
            const double top = 0.012 + random.range(0, 0.006);
            if (on_block(x, z) || x + h >= e) continue;
            add_part(site.ground, box({x - h, -0.05, z - h}, {x + h, top, z + h}), {}, setts);
            ++laid;
        }
    }
    site.triangles += 12 * laid;
}

}  // namespace

GeneratedModel city(const CityParams& p) {
    CHECK(p.triangles >= 1000 && p.triangles <= 1'000'000);
    CHECK(p.extent_m == 0 || (p.extent_m >= 60 && p.extent_m <= 4000));
    const Random dice(static_cast<std::uint64_t>(p.seed));
    // Room for a number of houses that grows more slowly than the triangles: richer towns have more to look
    // at.
    const double houses = 24 * num::pow(static_cast<double>(p.triangles) / 1000, 0.35);
    const double extent_m = p.extent_m > 0 ? p.extent_m : std::sqrt(520 * houses) + 20;

    // Coarser lots until bare bodies leave something for ornament.
    Site site;
    for (double scale = 1;; scale *= 1.2) {
        site = bare_site(extent_m, scale, dice.state);
        if (static_cast<double>(site.triangles) < 0.8 * static_cast<double>(p.triangles)) break;
        CHECK(scale < 1000);
    }
    refine(site, p.triangles, dice.fork(3));
    pave(site, p.triangles, dice.fork(4));

    GeneratedModel model;
    model.materials = slots();
    add_parts(model.mesh, site.ground, {}, 0);
    for (std::size_t i = 0; i < site.built.size(); ++i) {
        const CityItem& item = site.plan.items[i];
        add_parts(model.mesh, site.built[i],
                  translation(item.x, item.y, item.z) * rotation_y(90 * item.turns), 0);
    }
    return model;
}

}  // namespace obscura
