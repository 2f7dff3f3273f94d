#include "bench/stereo/scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "core/error.h"

namespace obscura {
namespace {

// Indices of objects; poles follow.
constexpr std::uint32_t wall = 0, ground = 1, first_sphere = 2, box = 7, first_pole = 8;
constexpr int matched_objects = 12;  // that further matching sets take turns with: spheres, box, six poles

constexpr std::uint32_t anchored_sphere = first_sphere + 3, lifted_sphere = first_sphere + 4;

/// In fractions of the picture's width (centre_y: of its height) and pixels of a picture 1920 wide.
struct BenchSphere {
    double centre_x, centre_y, radius, disparity;
};
constexpr BenchSphere spheres[5] = {{0.15, 0.55, 0.06, -8},
                                    {0.33, 0.62, 0.072, 4},
                                    {0.5, 0.45, 0.096, -3},
                                    {0.68, 0.66, 0.06, 12},
                                    {0.86, 0.5, 0.066, -12}};
constexpr double sphere_bulge = 10;

double roundness_of(std::uint32_t object) {
    if (object == first_sphere) return 2.5;
    if (object == first_sphere + 1) return 2.0;
    if (object == first_sphere + 2) return 0.3;
    return 1.0;
}

/// Pixels of this picture per pixel of one that is 1920 wide.
double pixel_scale(const MiddleView& view) {
    return view.picture_width / 1920.0;
}

/// Nearest thing wins.
void put(MiddleView& view, int x, int y, std::uint32_t object, double disparity, const Vec3f& normal) {
    const auto px = static_cast<float>(disparity * pixel_scale(view));
    if (!(px > view.disparity(x, y))) return;
    view.disparity(x, y) = px;
    view.object(x, y) = object;
    view.material(x, y) = object;
    view.normal(x, y) = normal;
}

void put_background(MiddleView& view, bool sky) {
    for (int y = 0; y < view.height(); ++y) {
        const double v = (y + 0.5) / view.height();
        for (int x = 0; x < view.width(); ++x) {
            if (sky && v < 0.45) {
                view.disparity(x, y) = static_cast<float>(-40 * pixel_scale(view));
                continue;
            }
            if (v > 0.6)
                put(view, x, y, ground, -20 + (v - 0.6) / 0.4 * 45, {0, 1, 0});
            else
                put(view, x, y, wall, -20, {0, 0, -1});
        }
    }
}

void put_spheres(MiddleView& view) {
    const double width = view.width(), height = view.height();
    for (std::uint32_t i = 0; i < 5; ++i) {
        const BenchSphere& sphere = spheres[i];
        for (int y = 0; y < view.height(); ++y) {
            for (int x = 0; x < view.width(); ++x) {
                const double dx = ((x + 0.5) / width - sphere.centre_x) / sphere.radius;
                const double dy = ((y + 0.5) / height - sphere.centre_y) * height / width / sphere.radius;
                const double t = 1 - dx * dx - dy * dy;
                if (!(t > 0)) continue;
                const double z = std::sqrt(t);
                put(view, x, y, first_sphere + i, sphere.disparity + sphere_bulge * z,
                    {static_cast<float>(dx), static_cast<float>(-dy), static_cast<float>(-z)});
            }
        }
    }
}

void put_box(MiddleView& view) {
    const double width = view.width(), height = view.height();
    for (int y = static_cast<int>(height * 0.7); y < height * 0.9; ++y) {
        for (int x = static_cast<int>(width * 0.05); x < width * 0.2; ++x)
            put(view, x, y, box, 14 + 4 * (x / width - 0.05) / 0.15, {0, 0, -1});
    }
}

struct PoleRow {
    int count, thickness;
    double first_x, step_x;
};

void put_poles(MiddleView& view, const PoleRow& row) {
    for (int i = 0; i < row.count; ++i) {
        const int x0 = static_cast<int>(view.width() * (row.first_x + row.step_x * i));
        for (int y = static_cast<int>(view.height() * 0.1); y < view.height() * 0.95; ++y) {
            for (int x = x0; x < std::min(x0 + row.thickness, view.width()); ++x)
                put(view, x, y, first_pole + static_cast<std::uint32_t>(i), 20 + i % 6, {0, 0, -1});
        }
    }
}

/// Mean disparity per object; objects that are not seen have 0.
std::vector<double> mean_disparities(const MiddleView& view) {
    std::vector<double> sums, counts;
    for (std::size_t i = 0; i < view.object.pixels.size(); ++i) {
        const std::uint32_t object = view.object.pixels[i];
        if (object == nothing_seen) continue;
        if (object >= sums.size()) sums.resize(object + 1), counts.resize(object + 1);
        sums[object] += static_cast<double>(view.disparity.pixels[i]);
        counts[object] += 1;
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
        sums[i] /= std::max(1.0, counts[i]);
    return sums;
}

/// The disparity with this pixel's roundness edit and the anchored sphere's offset.
DisparityMap edited_map(StereoCase stereo_case, const MiddleView& view) {
    const std::vector<double> means = mean_disparities(view);
    const double offset = (stereo_case == StereoCase::offset_60 ? 60 : 8) * pixel_scale(view);
    DisparityMap edited = view.disparity;
    for (std::size_t i = 0; i < edited.pixels.size(); ++i) {
        const std::uint32_t object = view.object.pixels[i];
        if (object == nothing_seen) continue;
        const double mean = means[object], original = static_cast<double>(edited.pixels[i]);
        const double moved = object == anchored_sphere ? offset : 0;
        edited.pixels[i] = static_cast<float>(mean + (original - mean) * roundness_of(object) + moved);
    }
    return edited;
}

/// Wanted difference from pixel i to pixel j: as in the original, but within an object by its roundness.
float wanted_gradient(const MiddleView& view, std::size_t i, std::size_t j) {
    const float difference = view.disparity.pixels[j] - view.disparity.pixels[i];
    if (view.object.pixels[i] != view.object.pixels[j] || view.object.pixels[i] == nothing_seen)
        return difference;
    return difference * static_cast<float>(roundness_of(view.object.pixels[i]));
}

void want_gradients(const MiddleView& view, DisparitySystem& system) {
    const int width = view.width(), height = view.height();
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            if (x + 1 < width) system.gradient_x(x, y) = wanted_gradient(view, i, i + 1);
            if (y + 1 < height)
                system.gradient_y(x, y) = wanted_gradient(view, i, i + static_cast<std::size_t>(width));
        }
    }
}

bool has_thin_poles(StereoCase stereo_case) {
    return stereo_case == StereoCase::one_pixel_poles || stereo_case == StereoCase::poles_before_sky;
}

/// How far an object is anchored from `start`, pixels at 1920, and how strongly; weight 0: it is not.
struct BenchAnchor {
    double offset = 0, weight = 0;
};

BenchAnchor anchor_of(StereoCase stereo_case, std::uint32_t object) {
    const bool contradictory = stereo_case == StereoCase::contradictory;
    const bool heavy = contradictory || stereo_case == StereoCase::anchors_100;
    if (object == anchored_sphere) return {0, heavy ? 100.0 : 1.0};
    if (contradictory && object == lifted_sphere) return {25, 100};
    if (contradictory && object == ground) return {-15, 100};
    if (has_thin_poles(stereo_case) && object >= first_pole && object % 2 == 0) return {12, 1};
    return {};
}

void want_anchors(StereoCase stereo_case, const MiddleView& view, DisparitySystem& system) {
    const double pixels = view.reduction * view.reduction;
    for (std::size_t i = 0; i < view.object.pixels.size(); ++i) {
        if (view.object.pixels[i] == nothing_seen) continue;
        const BenchAnchor anchor = anchor_of(stereo_case, view.object.pixels[i]);
        if (!(anchor.weight > 0)) continue;
        system.anchor_weight.pixels[i] = static_cast<float>(anchor.weight * pixels);
        system.anchor_value.pixels[i] =
            system.start.pixels[i] + static_cast<float>(anchor.offset * pixel_scale(view));
    }
}

/// All pixels of an object follow one pixel, at the differences they have to their middle one.
MatchingSet object_following(const MiddleView& view, std::uint32_t object, int source_x, int source_y) {
    MatchingSet set;
    set.source_x = source_x;
    set.source_y = source_y;
    set.weight = static_cast<float>(view.reduction * view.reduction);
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            if (view.object(x, y) == object && (x != source_x || y != source_y))
                set.members.push_back({x, y, view.disparity(x, y)});
        }
    }
    if (set.members.empty()) return set;
    const float destination = set.members[set.members.size() / 2].target;
    for (MatchedPixel& member : set.members)
        member.target -= destination;
    return set;
}

void want_matches(StereoCase stereo_case, const MiddleView& view, DisparitySystem& system) {
    const int sets = stereo_case == StereoCase::many_sets     ? 16
                     : stereo_case == StereoCase::no_matching ? 0
                                                              : 1;
    std::mt19937 random(1);
    const auto anywhere = [&](int size) {
        return static_cast<int>(static_cast<double>(random()) / 4294967296.0 * size);
    };
    for (int i = 0; i < sets; ++i) {
        // The first: the second sphere follows a pixel of the third.
        const std::uint32_t object =
            first_sphere + (i == 0 ? 1 : static_cast<std::uint32_t>(i % matched_objects));
        const int x = i == 0 ? view.width() / 2 : anywhere(view.width());
        const int y = i == 0 ? static_cast<int>(view.height() * 0.45) : anywhere(view.height());
        if (view.object(x, y) == nothing_seen) continue;
        MatchingSet set = object_following(view, object, x, y);
        if (!set.members.empty()) system.sets.push_back(std::move(set));
    }
}

}  // namespace

std::vector<StereoCase> stereo_cases() {
    return {StereoCase::base,
            StereoCase::no_matching,
            StereoCase::anchors_100,
            StereoCase::contradictory,
            StereoCase::epsilon_1e8,
            StereoCase::offset_60,
            StereoCase::many_sets,
            StereoCase::sky,
            StereoCase::one_pixel_poles,
            StereoCase::poles_before_sky};
}

const char* stereo_case_name(StereoCase stereo_case) {
    switch (stereo_case) {
        case StereoCase::base:
            return "base";
        case StereoCase::no_matching:
            return "no matching set";
        case StereoCase::anchors_100:
            return "anchor of weight 100";
        case StereoCase::contradictory:
            return "contradictory anchors";
        case StereoCase::epsilon_1e8:
            return "epsilon 1e-8";
        case StereoCase::offset_60:
            return "offset of 60 px";
        case StereoCase::many_sets:
            return "16 matching sets";
        case StereoCase::sky:
            return "sky";
        case StereoCase::one_pixel_poles:
            return "60 poles of one pixel";
        case StereoCase::poles_before_sky:
            return "60 poles before sky";
    }
    return "";
}

MiddleView stereo_bench_view(StereoCase stereo_case, int width, int height) {
    CHECK(width >= 32 && height >= 16);
    MiddleView view;
    view.picture_width = width;
    view.picture_height = height;
    view.depth_m = Image<float>(width, height, 1.0f);
    view.normal = Image<Vec3f>(width, height);
    view.object = Image<std::uint32_t>(width, height, nothing_seen);
    view.material = view.object;
    view.disparity = DisparityMap(width, height, std::numeric_limits<float>::lowest());
    put_background(view, stereo_case == StereoCase::sky || stereo_case == StereoCase::poles_before_sky);
    put_spheres(view);
    put_box(view);
    if (has_thin_poles(stereo_case))
        put_poles(view, {60, 1, 0.02, 0.016});
    else
        put_poles(view, {6, std::max(1, width / 480), 0.1, 0.14});
    for (std::size_t i = 0; i < view.object.pixels.size(); ++i) {
        if (view.object.pixels[i] == nothing_seen)
            view.depth_m.pixels[i] = std::numeric_limits<float>::infinity();
    }
    return view;
}

DisparitySystem stereo_bench_system(StereoCase stereo_case, const MiddleView& view) {
    const int width = view.width(), height = view.height();
    DisparitySystem system;
    system.original = view.disparity;
    system.start = edited_map(stereo_case, view);
    system.gradient_x = Image<float>(width, height);
    system.gradient_y = system.gradient_x;
    system.anchor_weight = system.gradient_x;
    system.anchor_value = system.gradient_x;
    system.valid = Image<std::uint8_t>(width, height);
    for (std::size_t i = 0; i < view.object.pixels.size(); ++i)
        system.valid.pixels[i] = view.object.pixels[i] == nothing_seen ? 0 : 1;
    const double epsilon = stereo_case == StereoCase::epsilon_1e8 ? 1e-8 : 1e-4;
    system.epsilon = static_cast<float>(epsilon * view.reduction * view.reduction);
    want_gradients(view, system);
    want_anchors(stereo_case, view, system);
    want_matches(stereo_case, view, system);
    return system;
}

DisparitySystem stereo_bench_system(StereoCase stereo_case, int width, int height) {
    return stereo_bench_system(stereo_case, stereo_bench_view(stereo_case, width, height));
}

}  // namespace obscura
