#pragma once
// What a model that was read promises, whatever file it came from.

#include <cmath>

#include "app/models/model.h"
#include "core/error.h"

namespace obscura {

inline void check_model(const Model& model) {
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
    for (const Vec2f& t : mesh.uvs)
        CHECK(std::isfinite(t.x) && std::isfinite(t.y));
    for (const Vec3f& n : mesh.normals)
        CHECK(std::fabs(length(n) - 1.0f) < 1e-4f);
    for (const Plane& plane : mesh.faces)
        CHECK(std::fabs(length(plane.n) - 1.0) < 1e-9 && std::isfinite(plane.d));
    for (const Material& m : model.materials) {
        CHECK(m.texture < static_cast<std::int32_t>(model.texture_files.size()));
        for (const Vec3f& v : {m.base_color, m.emission})
            CHECK(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z));
        CHECK(m.roughness >= 0.02f && m.roughness <= 1.0f && m.metallic >= 0.0f && m.metallic <= 1.0f);
    }
}

}  // namespace obscura
