// What can be wrong between the parameters of a generator, each of which is in its own range.

#include <fmt/format.h>

#include "scenes/generators.h"

namespace obscura {
namespace {

/// "" when `holds`, else the message.
std::string unless(bool holds, std::string message) {
    return holds ? std::string{} : std::move(message);
}

}  // namespace

std::string problem(const ArcadeParams& p) {
    const double least_bay = 3.6 * p.column_radius_m, least_column = 0.3 + 4.5 * p.column_radius_m;
    if (!(p.bay_m > least_bay))
        return fmt::format("'bay_m' must be more than {:g} for such columns", least_bay);
    return unless(p.column_m > least_column,
                  fmt::format("'column_m' must be more than {:g} for such columns", least_column));
}

std::string problem(const FenceParams& p) {
    if (!(p.spacing_m > 4 * p.bar_radius_m)) return "'spacing_m' must be more than four times 'bar_radius_m'";
    return unless(p.post_every_m > p.spacing_m, "'post_every_m' must be more than 'spacing_m'");
}

std::string problem(const TreeParams& p) {
    return unless(p.height_m > p.trunk_m + 0.5, "'height_m' must be more than 'trunk_m' by half a metre");
}

std::string problem(const LampPostParams& p) {
    const double least = 1.6 + 2.2 * p.lantern_m;
    return unless(p.height_m > least,
                  fmt::format("'height_m' must be more than {:g} for such a lantern", least));
}

std::string problem(const PavementParams& p) {
    if (!(p.stone_m > 4 * p.joint_m)) return "'stone_m' must be more than four times 'joint_m'";
    return unless(p.width_m > p.stone_m && p.depth_m > p.stone_m,
                  "'stone_m' must be less than 'width_m' and 'depth_m'");
}

std::string problem(const RoofTilesParams& p) {
    return unless(p.width_m > 2 * p.tile_m, "'width_m' must be more than twice 'tile_m'");
}

std::string problem(const WindowParams& p) {
    if (!(p.width_m > 2.5 * p.frame_m && p.height_m > 2.5 * p.frame_m)) {
        return "'frame_m' must be less than 0.4 of 'width_m' and of 'height_m'";
    }
    return unless(2 * p.bar_m * p.columns < p.width_m && 2 * p.bar_m * p.rows < p.height_m,
                  "the bars leave no room between them: lower 'bar_m', 'columns' or 'rows'");
}

std::string problem(const PiercedWallParams& p) {
    if (!(p.width_m > p.openings * p.opening_width_m))
        return "'width_m' must be more than all openings together";
    return unless(p.height_m > p.sill_m + p.opening_height_m,
                  "'height_m' must be more than 'sill_m' + 'opening_height_m'");
}

}  // namespace obscura
