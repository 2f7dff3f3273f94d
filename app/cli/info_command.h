#pragma once
// obscura info FILE: what a mesh file holds.

#include <filesystem>
#include <iosfwd>
#include <vector>

#include "app/cli/command.h"
#include "app/models/model.h"
#include "core/limits.h"

namespace obscura {

/// The numbers that `info` prints.
struct MeshInfo {
    std::size_t triangles = 0, vertices = 0;  ///< vertices: positions in the file
    std::size_t objects = 0, materials = 0;
    std::size_t planar_faces = 0;             ///< that have an area
    std::size_t closed = 0, open = 0;         ///< components
    std::size_t closed_with_multi_edges = 0;  ///< closed, though some edge carries more than two triangles
    std::size_t inside_out = 0;               ///< closed components of negative volume
    TopologyReport topology;
    Vec3d min, max;  ///< of the positions in use, in the file's own frame
};

MeshInfo inspect(const Model& model);

struct InfoOptions {
    std::filesystem::path file;
    std::vector<std::filesystem::path> allowed_paths;  ///< besides the file's own folder
    bool allow_missing = false;
    Limits limits;
};

/// Writes the table to `out`. Returns the exit code; throws as load_obj() does.
int info_command(const InfoOptions& options, std::ostream& out);
/// To standard output.
int info_command(const InfoOptions& options);

/// The command line of it.
int run_info(const Arguments& arguments);

}  // namespace obscura
