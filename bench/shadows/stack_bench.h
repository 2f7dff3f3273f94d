#pragma once
// The part "stack" of the shadow bench: bytes of octrees beside their maps' quadtrees, and steps of their
// lookups.

#include <cstdint>
#include <string>
#include <vector>

#include "bench/harness/options.h"
#include "bench/shadows/scenes.h"
#include "hierarchy/stack/stack.h"

namespace obscura {

/// How the views of a stack are aimed.
enum class StackAim {
    apart,   ///< each at the middle of the scene, by itself
    ground,  ///< focused on the lowest plane of the scene
    median,  ///< focused on the median height of what faces up
    facing,  ///< focused on the plane through the middle of the scene that faces the lamp
};
const char* aim_name(StackAim aim);

/// One stack: a square lamp over a scene, twice its extent away from its middle towards the sun.
struct StackSubject {
    int resolution = 512, maps = 64;
    double light_percent = 5;  ///< side of the lamp, of the scene's extent
    StackAim aim = StackAim::ground;
    bool steps = false;  ///< count those of lookups too
};

/// Mean steps of the lookups of one point of a picture: nodes read, and runs of maps that were asked.
struct StackSteps {
    double quadtrees = 0;          ///< nodes of the maps' own quadtrees, one map after the other
    double each = 0;               ///< nodes, one map after the other: the paper's way with all samples
    double all = 0, all_runs = 0;  ///< all maps at once
};

struct StackRow {
    std::string scene;
    std::size_t triangles = 0;
    StackSubject subject;
    double parallax_texels = 0;  ///< focused: the longest way from map to map
    std::uint64_t quadtree_bytes = 0;
    std::vector<StackTrial> trials;
    int anisotropy = 0;
    std::uint64_t bytes = 0;  ///< of the octree that was chosen, padding included
    double build_s = 0;
    std::size_t points = 0, penumbra = 0;  ///< of the picture that ask, and those that some samples reach
    StackSteps everywhere, in_penumbra;
    std::string problem;
    double ratio() const { return static_cast<double>(bytes) / static_cast<double>(quadtree_bytes); }
};

std::vector<StackSubject> stack_subjects(const std::string& scene, bool quick);
StackRow measure_stack(const ShadowRecipe& recipe, const StackSubject& subject, const BenchOptions& options);

std::string stack_csv(const std::vector<StackRow>& rows);
std::string stack_markdown(const std::vector<StackRow>& rows);

/// The whole part: writes shadows_stack.csv and shadows_stack.md. Returns an exit code. Throws UsageError
/// when options.scene is in no scene's name.
int bench_stack(const BenchOptions& options);

}  // namespace obscura
