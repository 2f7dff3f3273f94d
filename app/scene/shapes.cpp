#include "app/scene/shapes.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/scene/generators.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

/// A micrometre: products of three lengths stay far from what floats cannot hold.
constexpr double least_length_m = 1e-6;
constexpr Range length_range{least_length_m, 1e6};

KeySpec length_key(const char* name, const char* doc) {
    return number_key(name, doc).in(length_range);
}

KeySpec count_key(const char* name, const char* doc, std::int64_t least, std::int64_t most,
                  std::int64_t fallback) {
    return integer_key(name, doc)
        .in({static_cast<double>(least), static_cast<double>(most)})
        .or_else(fallback);
}

int count(const SceneTable& t, const char* key) {
    return static_cast<int>(integer(t, key));
}

ShapeSpec box_shape() {
    return {
        {"box",
         "A box with its centre at the origin. 12 triangles.",
         {vec3_or_number_key("size_m", "Width, height and depth.").in(length_range).or_else(Vec3d{1, 1, 1})}},
        [](const SceneTable&) { return 12; },
        [](const SceneTable& t) {
            return GeneratedModel{box(vec3(t, "size_m")), {}};
        }};
}

ShapeSpec plane_shape() {
    return {
        {"plane",
         "A level sheet that faces up, with its centre at the origin. The only shape that is not a solid.",
         {
             length_key("width_m", "Along x.").or_else(1.0),
             length_key("depth_m", "Along z.").or_else(1.0),
             count_key("cells_x", "Squares along x.", 1, 4096, 1),
             count_key("cells_z", "Squares along z.", 1, 4096, 1),
         }},
        [](const SceneTable& t) { return 2 * integer(t, "cells_x") * integer(t, "cells_z"); },
        [](const SceneTable& t) {
            return GeneratedModel{
                plane(number(t, "width_m"), number(t, "depth_m"), count(t, "cells_x"), count(t, "cells_z")),
                {}};
        }};
}

ShapeSpec sphere_shape() {
    return {
        {"sphere",
         "A sphere about the origin.",
         {
             length_key("radius_m", "Radius.").or_else(0.5),
             count_key("segments", "Around.", 3, 4096, 64),
             count_key("rings", "From pole to pole.", 2, 4096, 32),
         }},
        [](const SceneTable& t) { return 2 * integer(t, "segments") * integer(t, "rings"); },
        [](const SceneTable& t) {
            return GeneratedModel{sphere(number(t, "radius_m"), count(t, "segments"), count(t, "rings")), {}};
        }};
}

ShapeSpec cylinder_shape() {
    return {{"cylinder",
             "An upright cylinder or cone with its base at y = 0.",
             {
                 length_key("radius_m", "Radius of the base.").or_else(0.5),
                 number_key("top_radius_m", "Radius of the top, when it is another; 0 makes a cone.")
                     .in({0, 1e6}),
                 length_key("height_m", "Height.").or_else(1.0),
                 count_key("segments", "Around.", 3, 4096, 48),
             }},
            [](const SceneTable& t) { return 4 * integer(t, "segments"); },
            [](const SceneTable& t) {
                const double base = number(t, "radius_m");
                const double top = t.has("top_radius_m") ? number(t, "top_radius_m") : base;
                return GeneratedModel{frustum(base, top, number(t, "height_m"), count(t, "segments")), {}};
            },
            [](const SceneTable& t) -> std::string {
                const double top = t.has("top_radius_m") ? number(t, "top_radius_m") : 0;
                return top == 0 || top >= least_length_m
                           ? ""
                           : fmt::format("'top_radius_m' must be 0 or at least {:g}", least_length_m);
            }};
}

ShapeSpec torus_shape() {
    return {{"torus",
             "A ring about the y axis.",
             {
                 length_key("radius_m", "From the axis to the middle of the tube; more than tube_radius_m.")
                     .or_else(0.5),
                 length_key("tube_radius_m", "Radius of the tube.").or_else(0.15),
                 count_key("segments", "Around the axis.", 3, 4096, 48),
                 count_key("sides", "Around the tube.", 3, 4096, 16),
             }},
            [](const SceneTable& t) { return 2 * integer(t, "segments") * integer(t, "sides"); },
            [](const SceneTable& t) {
                return GeneratedModel{torus(number(t, "radius_m"), number(t, "tube_radius_m"),
                                            count(t, "segments"), count(t, "sides")),
                                      {}};
            },
            [](const SceneTable& t) -> std::string {
                const double tube = number(t, "tube_radius_m"), radius = number(t, "radius_m");
                if (!(tube < radius)) return "'tube_radius_m' must be less than 'radius_m'";
                // Eight steps of a float at that radius for each side of the tube.
                const double least = 1e-6 * radius * static_cast<double>(integer(t, "sides"));
                if (tube >= least) return "";
                return fmt::format("'tube_radius_m' must be at least {:g} for such 'radius_m' and 'sides'",
                                   least);
            }};
}

}  // namespace

const std::vector<ShapeSpec>& shapes() {
    static const std::vector<ShapeSpec> all = [] {
        std::vector<ShapeSpec> list{box_shape(), plane_shape(), sphere_shape(), cylinder_shape(),
                                    torus_shape()};
        for (ShapeSpec& shape : generator_shapes())
            list.push_back(std::move(shape));
        return list;
    }();
    return all;
}

const ShapeSpec* find_shape(std::string_view name) {
    for (const ShapeSpec& shape : shapes()) {
        if (shape.variant.name == name) return &shape;
    }
    return nullptr;
}

std::int64_t max_triangles(const SceneTable& mesh) {
    const ShapeSpec* shape = find_shape(text(mesh, "shape"));
    const auto copies =
        static_cast<std::int64_t>(std::max<std::size_t>(1, subtables(mesh, "instance").size()));
    return shape == nullptr ? 0 : copies * shape->max_triangles(mesh);
}

}  // namespace obscura
