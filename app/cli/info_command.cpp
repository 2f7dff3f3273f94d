#include "app/cli/info_command.h"

#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "app/cli/flag_values.h"
#include "app/cli/flags.h"
#include "app/models/model_file.h"
#include "app/scene/texture_notes.h"
#include "core/edges.h"
#include "core/error.h"

namespace obscura {
namespace {

std::size_t count_if(const std::vector<Component>& components, auto&& predicate) {
    return static_cast<std::size_t>(std::count_if(components.begin(), components.end(), predicate));
}

std::size_t faces_with_area(const Mesh& mesh) {
    std::vector<bool> has_area(mesh.faces.size(), false);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& v = mesh.triangles[t].v;
        if (!is_degenerate(mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]])) {
            has_area[mesh.face[t]] = true;
        }
    }
    return static_cast<std::size_t>(std::count(has_area.begin(), has_area.end(), true));
}

void bounds(const Model& model, MeshInfo& info) {
    const std::vector<Vec3f>& positions = model.mesh.positions;
    if (positions.empty()) return;
    info.min = info.max = to_double(positions.front()) + model.origin;
    for (const Vec3f& stored : positions) {
        const Vec3d p = to_double(stored) + model.origin;
        info.min = {std::min(info.min.x, p.x), std::min(info.min.y, p.y), std::min(info.min.z, p.z)};
        info.max = {std::max(info.max.x, p.x), std::max(info.max.y, p.y), std::max(info.max.z, p.z)};
    }
}

template <class... Args>
void row(std::ostream& out, std::string_view label, fmt::format_string<Args...> format, Args&&... args) {
    fmt::print(out, "{:<22}{}\n", label, fmt::format(format, std::forward<Args>(args)...));
}

/// A corner of the box: six digits of what the mesh measures, and all that stand before them.
std::string corner_text(Vec3d corner, Vec3d extent) {
    const double largest = std::max({extent.x, extent.y, extent.z});
    const auto digits_of = [&](double v) {
        int digits = 6;
        for (double beyond = std::fabs(v); largest > 0 && beyond > 10 * largest && digits < 15; beyond /= 10)
            ++digits;
        return digits;
    };
    return fmt::format("({:.{}g}, {:.{}g}, {:.{}g})", corner.x, digits_of(corner.x), corner.y,
                       digits_of(corner.y), corner.z, digits_of(corner.z));
}

void write_table(const InfoOptions& options, const Model& model, const MeshInfo& info, std::ostream& out) {
    fmt::print(out, "{}\n", options.file.string());
    row(out, "triangles", "{}", info.triangles);
    row(out, "vertices", "{}", info.vertices);
    row(out, "objects", "{}", info.objects);
    row(out, "materials", "{}", info.materials);
    row(out, "textures", "{}", model.texture_files.size());
    row(out, "components", "{} closed, {} open", info.closed, info.open);
    row(out, "  of the closed", "{} with balanced multi-edges, {} inside out", info.closed_with_multi_edges,
        info.inside_out);
    const auto edges = [&](std::string_view label, const TopologyReport::Edges& e) {
        row(out, label, "{} without a partner, {} with more than two faces", e.open, e.multi);
    };
    edges("edges, by index", info.topology.by_index);
    edges("edges, welded", info.topology.welded);
    row(out, "degenerate triangles", "{}", info.topology.degenerate_triangles);
    row(out, "planar faces", "{}", info.planar_faces);
    const Vec3d extent = info.max - info.min;
    row(out, "bounding box", "{} / {}", corner_text(info.min, extent), corner_text(info.max, extent));
    for (const std::string& message : model.missing)
        fmt::print(out, "missing: {}\n", message);
    for (const std::string& note : model.notes)
        fmt::print(out, "note: {}\n", note);
    const auto file_of = [&](std::int32_t texture) {
        const auto& files = model.texture_files;
        return std::filesystem::path(files.at(static_cast<std::size_t>(texture))).filename().string();
    };
    for (const std::string& note :
         texture_notes(options.file.string(), model.mesh, model.without_uv, model.materials, file_of))
        fmt::print(out, "note: {}\n", note);
}

}  // namespace

MeshInfo inspect(const Model& model) {
    const Mesh& mesh = model.mesh;
    MeshInfo info;
    info.triangles = mesh.triangles.size();
    info.vertices = model.file_positions;
    info.objects = mesh.objects.size();
    info.materials = model.materials.size();
    info.planar_faces = faces_with_area(mesh);
    info.topology = model.topology;
    info.closed = count_if(mesh.components, [](const Component& c) { return c.closed; });
    info.open = mesh.components.size() - info.closed;
    info.closed_with_multi_edges =
        count_if(mesh.components, [](const Component& c) { return c.closed && c.balanced_multi_edges; });
    const std::vector<double> volumes = signed_volumes(mesh);
    for (std::size_t c = 0; c < volumes.size(); ++c)
        info.inside_out += mesh.components[c].closed && volumes[c] < 0;
    bounds(model, info);
    return info;
}

int info_command(const InfoOptions& options, std::ostream& out) {
    // The user named this file, so it may be a link; what it names in turn must lie beside it.
    std::error_code error;
    std::filesystem::path file = std::filesystem::canonical(options.file, error);
    if (error) file = options.file;
    const FileAccess access{file.parent_path(), options.allowed_paths};
    ModelOptions obj;
    obj.allow_missing = options.allow_missing;
    obj.textures = false;  // none is read
    const Model model = load_model(file, access, options.limits, obj);
    write_table(options, model, inspect(model), out);
    return static_cast<int>(ExitCode::ok);
}

int info_command(const InfoOptions& options) {
    return info_command(options, std::cout);
}

int run_info(const Arguments& arguments) {
    Flags flags("info [options] FILE",
                "Prints what a mesh file (Wavefront OBJ, glTF, PLY, STL) holds: triangles, components closed "
                "or open, open "
                "edges, bounding box in the file's own units, degenerate triangles.");
    std::string file;
    std::vector<std::string> allowed;
    InfoOptions options;
    flags.positional("FILE", file, "The mesh file.");
    flags.group("Input");
    flags.list("--allow-path", "DIR", allowed,
               "A folder besides the file's own that material files may lie in; may be given again.");
    flags.on_off(
        "--allow-missing", options.allow_missing,
        "Go on without material files and materials that are not there; without textures it always does.");
    if (!flags.parse(arguments)) return 0;
    options.file = file;
    options.allowed_paths = folder_values("--allow-path", allowed);
    return info_command(options);
}

}  // namespace obscura
