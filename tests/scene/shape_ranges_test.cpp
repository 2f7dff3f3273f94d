// Every shape over the whole ranges of its keys: what the rows allow is made, or refused with the key's name.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <random>

#include "app/scene/shapes.h"
#include "app/scene/toml_text.h"
#include "core/topology.h"
#include "tests/core/mesh_checks.h"

namespace obscura {
namespace {

/// Values for the keys of a shape, drawn from the keys' own ranges with their ends.
class Settings {
  public:
    explicit Settings(std::uint64_t seed) : engine_(seed) {}

    SceneTable draw(const ShapeSpec& shape) {
        SceneTable table;
        for (const KeySpec& key : shape.variant.keys) {
            if (!key.fallback && chance() < 0.5) continue;
            if (key.type == KeyType::integer) {
                table.set(key.name, value_of(std::int64_t{std::llround(number(key))}));
            } else if (key.type == KeyType::vec3_or_number) {
                table.set(key.name, value_of(Vec3d{number(key), number(key), number(key)}));
            } else {
                table.set(key.name, value_of(number(key)));
            }
        }
        return table;
    }

  private:
    double chance() { return std::uniform_real_distribution<>(0, 1)(engine_); }

    double number(const KeySpec& key) {
        const Range& r = key.range;
        // The nearest that the range allows: an open end is approached.
        const double lo = r.open_lo ? std::nextafter(r.lo, r.hi) : r.lo;
        const double hi = r.open_hi ? std::nextafter(r.hi, r.lo) : r.hi;
        const double kind = chance();
        if (kind < 0.15) return lo;
        if (kind < 0.25) return hi;
        if (kind < 0.30) return lo + (hi - lo) * chance();
        // By magnitude, between the ends or, where the range begins at 0, down to what no float holds.
        const double least = std::max(lo, chance() < 0.2 ? 1e-320 : 1e-3);
        return std::clamp(least * std::pow(std::max(hi, least) / least, chance()), lo, hi);
    }

    std::mt19937_64 engine_;
};

std::string told(const SceneTable& table) {
    std::string out;
    for (const SceneEntry& entry : table.entries)
        out += fmt::format(" -D mesh.a.{}={}", entry.key, toml_text(entry.value));
    return out;
}

bool names_a_key(const std::string& problem, const ShapeSpec& shape) {
    return std::any_of(shape.variant.keys.begin(), shape.variant.keys.end(), [&](const KeySpec& key) {
        return problem.find("'" + key.name + "'") != std::string::npos;
    });
}

std::size_t not_unit(const std::vector<Vec3f>& normals) {
    return static_cast<std::size_t>(std::count_if(
        normals.begin(), normals.end(), [](Vec3f n) { return !(std::fabs(length(n) - 1) < 1e-5f); }));
}

void expect_sound(const ShapeSpec& shape, GeneratedModel model) {
    const Mesh& mesh = model.mesh;
    for (const std::uint32_t m : mesh.material)
        ASSERT_LT(m, std::max<std::size_t>(1, model.materials.size()));
    const mesh_checks::Verdict v = mesh_checks::inspect(mesh);
    EXPECT_TRUE(v.arrays_agree);
    EXPECT_EQ(not_unit(mesh.normals), 0u);
    // Where rock overhangs or a twig turns back sharply, smooth normals look behind some triangle.
    const bool rough = shape.variant.name == "cliffs" || shape.variant.name == "tree";
    EXPECT_EQ(rough ? 0u : v.bad_normals, 0u);
    EXPECT_EQ(v.degenerate, 0u);
    if (shape.variant.name != "plane") {
        EXPECT_GT(v.solids, 0u);
        EXPECT_EQ(v.open_parts, 0u);
        EXPECT_EQ(v.inside_out, 0u);
    }
    analyse_topology(model.mesh);
}

bool slow_tests() {
    const char* set = std::getenv("OBSCURA_SLOW_TESTS");
    return set != nullptr && std::strcmp(set, "1") == 0;
}

class ShapeRanges : public testing::TestWithParam<std::string> {};

TEST_P(ShapeRanges, WhatTheRowsAllowIsMadeOrRefused) {
    const ShapeSpec& shape = *find_shape(GetParam());
    // Triangles are counted, so that the time is: what is made, and of it what is looked at.
    const std::int64_t times = slow_tests() ? 20 : 1;
    std::int64_t left_to_make = 60'000 * times, left_to_inspect = 20'000 * times;
    constexpr std::int64_t few = 3'000, many = 110'000;
    // A town is planned whole, however few its triangles.
    const std::int64_t cost_of_one = shape.variant.name != "city" ? 0 : slow_tests() ? 100'000 : 20'000;
    Settings source(7);
    int made = 0, inspected = 0, refused = 0;
    for (int i = 0; i < 1000 && left_to_make > 0 && !HasFailure(); ++i) {
        SceneTable table = source.draw(shape);
        SCOPED_TRACE(shape.variant.name + told(table));
        const std::string problem = shape.problem != nullptr ? shape.problem(table) : "";
        if (!problem.empty()) {
            EXPECT_TRUE(names_a_key(problem, shape)) << problem;
            ++refused;
            continue;
        }
        const std::int64_t bound = shape.max_triangles(table);
        // Of the large ones each tenth.
        if (bound > (i % 10 == 0 ? many : few)) continue;
        GeneratedModel model = shape.make(table);
        const auto count = static_cast<std::int64_t>(model.mesh.triangles.size());
        EXPECT_TRUE(count > 0 && count <= bound) << count;
        left_to_make -= std::max(count, cost_of_one);
        ++made;
        if (left_to_inspect <= 0) continue;
        left_to_inspect -= count;
        expect_sound(shape, std::move(model));
        ++inspected;
    }
    fmt::print("{}: {} made, {} of them inspected, {} refused\n", shape.variant.name, made, inspected,
               refused);
    EXPECT_GT(inspected, 0);
}

std::vector<std::string> shape_names() {
    std::vector<std::string> names;
    for (const ShapeSpec& shape : shapes())
        names.push_back(shape.variant.name);
    return names;
}

INSTANTIATE_TEST_SUITE_P(All, ShapeRanges, testing::ValuesIn(shape_names()),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace obscura
