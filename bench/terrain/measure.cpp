#include <fmt/format.h>

#include <algorithm>

#include "app/elevation/elevation.h"
#include "app/models/file_access.h"
#include "bench/terrain/terrain_bench.h"
#include "bench/terrain/terrain_peers.h"
#include "core/stopwatch.h"
#include "core/sun_path.h"
#include "hierarchy/terrain/far_day.h"
#include "raster/heights/height_near.h"
#include "raster/heights/height_sweep.h"
#include "scenes/ridges.h"

namespace obscura {
namespace {

const Exec one_thread{best_isa(), 1};

/// Real ones, with the thresholds that notes on them use: as far as near rays may be asked to go.
struct KnownModel {
    const char* name;
    int threshold;
};
constexpr KnownModel known_models[] = {{"jacksboro", 6},
                                       {"baltoro_srtm3", 6},
                                       {"etna_srtm3", 6},
                                       {"sierra_30m", 16},
                                       {"greenriver_lidar_1m", 128}};

TerrainSubject generated() {
    RidgesParams params;
    const Image<std::uint16_t> codes = ridges(params);
    TerrainSubject s{
        "ridges", {Image<std::int32_t>(codes.width, codes.height), 30, 30, Diagonal::falling}, 8};
    std::transform(codes.pixels.begin(), codes.pixels.end(), s.field.height_q16.pixels.begin(),
                   [](std::uint16_t code) { return height_q16_of(code * ridges_step_m); });
    return s;
}

/// A day of 13 hours at 38 degrees north.
std::vector<FarSun> day_over(const HeightField& field, int count) {
    SunPath day;
    day.year = 2024, day.month = 4, day.day = 12, day.latitude_deg = 38, day.steps = count;
    std::vector<FarSun> suns;
    for (const SunStep& s : sun_steps_by_travel(day, 0.5)) {
        suns.push_back({s.hour_h, s.hours, s.azimuth_deg, s.elevation_deg,
                        height_sun(field, s.azimuth_deg, s.elevation_deg)});
    }
    return suns;
}

std::int64_t differing(const ShadowBits& a, const ShadowBits& b) {
    ShadowBits x = a;
    for (std::size_t i = 0; i < x.words.size(); ++i)
        x.words[i] ^= b.words[i];
    return count_of(x);
}

double ns_each(double seconds, std::int64_t samples) {
    return samples > 0 ? 1e9 * seconds / static_cast<double>(samples) : 0;
}

struct Maps {
    std::vector<ShadowBits> whole, far_bits;
};

/// All suns by the sweep: whole shadows alone, and with the far ones.
Maps sweep_day(const TerrainSubject& subject, const std::vector<FarSun>& suns, TerrainRow& row) {
    const std::int64_t each = std::int64_t{row.width} * row.height;
    const int whole[] = {0}, both[] = {0, subject.threshold};
    Maps maps;
    SweepStats stats;
    double whole_s = 0, both_s = 0;
    std::int64_t dark = 0, far_dark = 0;
    for (const FarSun& sun : suns) {
        Stopwatch watch;
        sweep_shadows(subject.field, sun.direction, whole);
        whole_s += watch.seconds();
        watch = {};
        auto found = sweep_shadows(subject.field, sun.direction, both, &stats);
        both_s += watch.seconds();
        dark += count_of(found[0]);
        far_dark += count_of(found[1]);
        maps.whole.push_back(std::move(found[0]));
        maps.far_bits.push_back(std::move(found[1]));
    }
    const std::int64_t samples = each * static_cast<std::int64_t>(suns.size());
    row.sweep = {ns_each(whole_s, samples), samples, 0};
    row.sweep_far = {ns_each(both_s, samples), samples, 0};
    row.dark = static_cast<double>(dark) / static_cast<double>(samples);
    row.far_dark = static_cast<double>(far_dark) / static_cast<double>(samples);
    row.marched = static_cast<double>(stats.marched) / static_cast<double>(stats.samples);
    return maps;
}

/// Rays by themselves, of every 13th row under every step-th sun.
TerrainWay march_some(const TerrainSubject& subject, const std::vector<FarSun>& suns, const Maps& maps,
                      std::size_t step) {
    const HeightField& field = subject.field;
    ShadowBits asked(field.width(), field.height());
    for (int y = 0; y < field.height(); y += 13) {
        for (int x = 0; x < field.width(); ++x)
            asked.set(x, y);
    }
    TerrainWay way;
    double seconds = 0;
    for (std::size_t i = 0; i < suns.size(); i += step) {
        const Stopwatch watch;
        const ShadowBits marched = near_shadows(field, suns[i].direction, largest_height_field_side, asked);
        seconds += watch.seconds();
        ShadowBits swept = maps.whole[i];
        for (std::size_t w = 0; w < swept.words.size(); ++w)
            swept.words[w] &= asked.words[w];
        way.differ += differing(swept, marched);
        way.samples += count_of(asked);
    }
    way.ns_per_sample = ns_each(seconds, way.samples);
    return way;
}

std::optional<TerrainWay> trace_some(const TerrainSubject& subject, const std::vector<FarSun>& suns,
                                     const Maps& maps, std::size_t step) {
    std::vector<HeightSun> some;
    for (std::size_t i = 0; i < suns.size(); i += step)
        some.push_back(suns[i].direction);
    const auto traced = embree_shadows(subject.field, some);
    if (!traced) return {};
    TerrainWay way;
    double seconds = 0;
    for (std::size_t i = 0; i < traced->size(); ++i) {
        seconds += (*traced)[i].seconds;
        way.differ += differing((*traced)[i].map, maps.whole[i * step]);
        way.samples += std::int64_t{subject.field.width()} * subject.field.height();
    }
    way.ns_per_sample = ns_each(seconds, way.samples);
    return way;
}

void measure_codes(const TerrainSubject& subject, const std::vector<FarSun>& suns, const Maps& maps,
                   std::size_t step, TerrainRow& row) {
    FarDayParams params;
    params.threshold = subject.threshold;
    const FarDay day = make_far_day(subject.field, suns, params, {});
    const auto samples = static_cast<double>(row.sweep.samples);
    row.far_bits = 8 * static_cast<double>(day.bytes.size() + day.units.size() * sizeof(FarUnit)) / samples;
    const Stopwatch watch;
    for (int group = 0; group < day.groups(); ++group)
        far_maps(day, group, one_thread);
    row.decode_ns = ns_each(watch.seconds(), row.sweep.samples);
    measure_lookups(subject, day, maps.whole, step, row);

    std::int64_t paper = 0;
    for (const ShadowBits& map : maps.far_bits) {
        const auto bytes = dictionary_lzma_bytes(map);
        if (!bytes) return;
        paper += *bytes;
    }
    row.paper_bits = 8 * static_cast<double>(paper) / samples;
}

}  // namespace

std::vector<TerrainSubject> terrain_subjects(const BenchOptions& options) {
    constexpr std::int64_t largest_file = std::int64_t{1} << 30;
    std::vector<TerrainSubject> subjects;
    subjects.push_back(generated());
    if (options.quick || !options.data) return subjects;
    for (const KnownModel& known : known_models) {
        const std::string name = std::string(known.name) + ".pgm";
        const auto file = *options.data / "terrain" / name;
        if (!std::filesystem::exists(file)) continue;
        const std::string description =
            read_file(*options.data / "terrain" / sidecar_name(name), largest_file);
        subjects.push_back({known.name,
                            decode_elevation(read_file(file, largest_file), name, description, {}).field,
                            known.threshold});
    }
    return subjects;
}

TerrainRow measure_terrain(const TerrainSubject& subject, const BenchOptions& options) {
    TerrainRow row;
    row.name = subject.name;
    row.width = subject.field.width();
    row.height = subject.field.height();
    row.threshold = subject.threshold;
    const std::vector<FarSun> suns = day_over(subject.field, options.quick ? 12 : 158);
    row.suns = static_cast<int>(suns.size());
    const std::size_t step = options.quick ? 4 : 16;
    const Maps maps = sweep_day(subject, suns, row);
    row.march = march_some(subject, suns, maps, step);
    row.embree = trace_some(subject, suns, maps, step);
    measure_codes(subject, suns, maps, step, row);
    return row;
}

}  // namespace obscura
