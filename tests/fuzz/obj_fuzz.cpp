#include "tests/fuzz/obj_fuzz.h"

#include <cmath>
#include <string_view>

#include "app/scene/obj_file.h"
#include "core/error.h"
#include "tests/fuzz/obj_peer.h"

namespace obscura {
namespace {

void check_model(const ObjModel& model) {
    const Mesh& mesh = model.mesh;
    const std::size_t vertices = mesh.positions.size(), triangles = mesh.triangles.size();
    CHECK(mesh.normals.size() == vertices && (mesh.uvs.empty() || mesh.uvs.size() == vertices));
    CHECK(mesh.material.size() == triangles && mesh.object.size() == triangles);
    CHECK(mesh.component.size() == triangles && mesh.face.size() == triangles);
    for (std::size_t t = 0; t < triangles; ++t) {
        for (const std::uint32_t v : mesh.triangles[t].v)
            CHECK(v < vertices);
        CHECK(mesh.material[t] < model.materials.size() && mesh.object[t] < mesh.objects.size());
        CHECK(mesh.component[t] < mesh.components.size() && mesh.face[t] < mesh.faces.size());
    }
    for (const Vec3f& p : mesh.positions)
        CHECK(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    for (const Vec3f& n : mesh.normals)
        CHECK(std::fabs(length(n) - 1.0f) < 1e-4f);
    for (const Plane& plane : mesh.faces)
        CHECK(std::fabs(length(plane.n) - 1.0) < 1e-9 && std::isfinite(plane.d));
    for (const Material& m : model.materials) {
        CHECK(m.texture < static_cast<std::int32_t>(model.texture_files.size()));
        CHECK(m.roughness >= 0.02f && m.roughness <= 1.0f && m.metallic >= 0.0f && m.metallic <= 1.0f);
    }
}

}  // namespace

void try_obj(std::span<const std::uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t cut = text.find('\0');
    const std::string_view mtl = cut == std::string_view::npos ? std::string_view() : text.substr(cut + 1);
    Limits limits;
    limits.triangles = 20'000;
    try {
        check_model(obj_from_text(text.substr(0, cut), mtl, limits));
        const PeerResult peer = read_by_both(text.substr(0, cut), mtl, limits);
        CHECK(peer.difference.empty(), peer.difference);
    } catch (const InputError&) {
    } catch (const LimitError&) {
    }
}

}  // namespace obscura

#ifdef OBSCURA_FUZZER
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    obscura::try_obj({data, size});
    return 0;
}
#endif
