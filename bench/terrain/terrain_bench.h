#pragma once
// The terrain bench: exact shadows of a day over elevation models by sweep, march and rays, and what their
// far maps take.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/harness/options.h"
#include "hierarchy/terrain/far_day.h"
#include "raster/heights/height_field.h"
#include "raster/heights/shadow_bits.h"

namespace obscura {

/// An elevation model, and the threshold of its far shadows in lines of its grid.
struct TerrainSubject {
    std::string name;
    HeightField field;
    int threshold = 16;
};

/// One way to find a map: time, and bits that differ from the sweep's.
struct TerrainWay {
    double ns_per_sample = 0;
    std::int64_t samples = 0;  ///< asked, of some suns or lines
    std::int64_t differ = 0;
};

/// Rays of one kind from the ground: what each looks at, and takes.
struct TerrainRays {
    std::int64_t rays = 0;
    double looks = 0, plain_looks = 0;  ///< cells and blocks of the pyramid; cells without it
    double ns = 0, plain_ns = 0;
    std::int64_t differ = 0;  ///< answers with and without
};

struct TerrainRow {
    std::string name;
    int width = 0, height = 0, threshold = 0, suns = 0;
    double dark = 0, far_dark = 0;  ///< shares of the samples, all suns
    TerrainWay sweep, sweep_far,
        march;           ///< whole shadows; whole and far ones together; whole ones by rays in doubles
    double marched = 0;  ///< share of the sweep's samples that integers decided
    std::optional<TerrainWay> embree;  ///< with its hierarchy kept
    TerrainRays near_rays;             ///< up to the threshold, where far bits do not answer
    TerrainRays all_rays;              ///< to the border, what points above the ground ask
    TerrainWay lookup;                 ///< a day's file asked at samples
    double far_bits = 0;               ///< per sample and map, index included
    std::optional<double> paper_bits;  ///< dictionary and LZMA
    double decode_ns = 0;              ///< per sample and map
};

/// Far bits and near rays of every 13th row under every step-th sun, as pictures ask them: at samples, of
/// which `whole` has the shadows, and in the middles of cells.
void measure_lookups(const TerrainSubject& subject, const FarDay& day, const std::vector<ShadowBits>& whole,
                     std::size_t step, TerrainRow& row);

std::vector<TerrainSubject> terrain_subjects(const BenchOptions& options);
TerrainRow measure_terrain(const TerrainSubject& subject, const BenchOptions& options);

std::string terrain_csv(const std::vector<TerrainRow>& rows);
std::string terrain_markdown(const std::vector<TerrainRow>& rows);

/// Writes terrain.csv and terrain.md. Returns an exit code. Throws UsageError when options.scene is in no
/// model's name.
int bench_terrain(const BenchOptions& options);

}  // namespace obscura
