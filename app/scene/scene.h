#pragma once
// What rendering a frame takes, after the scene file has been read: what is seen (core/scene.h) and how it is
// rendered.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/scene/optics_settings.h"
#include "app/scene/shadow_settings.h"
#include "core/emitter_surface.h"
#include "core/limits.h"
#include "core/mesh.h"
#include "core/scene.h"
#include "filters/tonemap.h"
#include "raster/intervals.h"

namespace obscura {

struct GroundDay;
struct HeightField;

struct RenderSettings {
    int width = 960, height = 540;  ///< pixels
    int samples = 4;                ///< per pixel: 1, 4 or 16
    double exposure_ev = 0.0;       ///< linear radiance is scaled by 2^exposure_ev
    ToneCurve tone = ToneCurve::filmic;
    Receivers receivers = Receivers::static_only;
    friend bool operator==(const RenderSettings&, const RenderSettings&) = default;
};

enum class Aov { beauty, depth, normal, albedo, object, shadow, sun_hours };

struct Output {
    Aov aov = Aov::beauty;
    std::string file;  ///< "####" stands for the frame number
    friend bool operator==(const Output&, const Output&) = default;
};

/// A light, and how its shadows are made.
struct SceneLight {
    Light light;
    ShadowSettings shadow;
    friend bool operator==(const SceneLight&, const SceneLight&) = default;
};

/// A [[terrain]] of the scene that a light's `day` may be of.
struct SceneTerrain {
    std::string id;
    std::shared_ptr<const HeightField> field;
    Vec3d middle_m;                    ///< where height 0 of its middle stands
    std::uint32_t first_triangle = 0;  ///< its own are ground, cell by cell, then walls and floor
    std::uint32_t ground_triangles = 0, triangles = 0;
    bool casts_shadow = true;
};

/// What a light's `day_file` holds, and which terrain it is of.
struct SceneDay {
    std::shared_ptr<const GroundDay> ground;
    std::size_t terrain = 0;  ///< index into Scene::terrains
};

/// One frame's worth of scene: everything is in world space and final.
struct Scene {
    Mesh mesh;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    Camera camera;
    std::vector<SceneLight> lights;
    /// What lights of surfaces shine from, by the name of the material.
    std::map<std::string, std::shared_ptr<const EmitterSurface>> emitters;
    std::vector<SceneTerrain> terrains;    ///< where some light has a `day`, else none
    std::map<std::string, SceneDay> days;  ///< by the light's id
    Sky sky;
    RenderSettings render;
    OpticsSettings optics;
    std::vector<Output> outputs;
    Limits limits;
    /// What files hold and the scene has not, and other words for who made it.
    std::vector<std::string> notes;
};

}  // namespace obscura
