#include <memory>
#include <vector>

#include "bench/terrain/terrain_bench.h"
#include "core/isa.h"
#include "core/stopwatch.h"
#include "hierarchy/terrain/day_shadow.h"

namespace obscura {
namespace {

double ns_each(double seconds, std::int64_t count) {
    return count > 0 ? 1e9 * seconds / static_cast<double>(count) : 0;
}

/// The same rays with and without the pyramid.
struct RaySums {
    HeightRayCounts with, plain;
    double with_s = 0, plain_s = 0;
    std::int64_t differ = 0;

    void ask(const HeightRays& rays, const HeightRays& plain_rays, const std::vector<GroundPlace>& places,
             int lines) {
        std::vector<bool> dark(places.size());
        const Stopwatch watch;
        for (std::size_t i = 0; i < places.size(); ++i)
            dark[i] = rays.ground_hidden(places[i], lines, &with);
        with_s += watch.seconds();
        const Stopwatch again;
        for (std::size_t i = 0; i < places.size(); ++i)
            differ += plain_rays.ground_hidden(places[i], lines, &plain) != dark[i];
        plain_s += again.seconds();
    }
    TerrainRays result() const {
        const auto per_ray = [&](std::int64_t looks) {
            return with.rays > 0 ? static_cast<double>(looks) / static_cast<double>(with.rays) : 0;
        };
        return {with.rays,
                per_ray(with.cells + with.blocks),
                per_ray(plain.cells + plain.blocks),
                ns_each(with_s, with.rays),
                ns_each(plain_s, plain.rays),
                differ};
    }
};

}  // namespace

void measure_lookups(const TerrainSubject& subject, const FarDay& day, const std::vector<ShadowBits>& whole,
                     std::size_t step, TerrainRow& row) {
    GroundDay made{std::make_shared<const HeightField>(subject.field), height_pyramid(subject.field), day,
                   "day"};
    const auto ground = std::make_shared<const GroundDay>(std::move(made));
    const HeightField& field = *ground->field;
    const HeightPyramid none;
    RaySums near_sums, all_sums;
    double lookup_s = 0;
    for (std::size_t i = 0; i < day.suns.size(); i += step) {
        const auto sun = day_sun(ground, static_cast<int>(i), {best_isa(), 1});
        const HeightRays plain(field, none, day.suns[i].direction);
        std::vector<GroundPlace> samples, middles;
        for (int y = 0; y + 1 < field.height(); y += 13) {
            for (int x = 0; x + 1 < field.width(); ++x) {
                samples.push_back({x, y, 0, 0});
                if (!sun->far_bits(x, y)) middles.push_back({x, y, 0.5, 0.5});
            }
        }
        const Stopwatch watch;
        for (const GroundPlace& place : samples)
            row.lookup.differ += ground_dark(*sun, place) != whole[i](place.cell_x, place.cell_y);
        lookup_s += watch.seconds();
        row.lookup.samples += static_cast<std::int64_t>(samples.size());
        near_sums.ask(sun->rays, plain, middles, subject.threshold);
        all_sums.ask(sun->rays, plain, middles, largest_height_field_side);
    }
    row.lookup.ns_per_sample = ns_each(lookup_s, row.lookup.samples);
    row.near_rays = near_sums.result();
    row.all_rays = all_sums.result();
}

}  // namespace obscura
