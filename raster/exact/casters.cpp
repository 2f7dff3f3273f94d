#include "raster/exact/casters.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/morton.h"
#include "core/parallel.h"
#include "core/vec_arrays.h"
#include "raster/light_samples.h"
#include "raster/shadow_map.h"
#include "raster/view.h"

namespace obscura {
namespace {

constexpr std::size_t group = 16;
constexpr std::int32_t most_step = std::numeric_limits<std::int32_t>::max();

/// Depths are floats in [0, 1], rounded twice on their way here: four units in the last place.
constexpr float depth_error = 0x1p-22f;

std::size_t groups_of(std::size_t n) {
    return (n + group - 1) / group;
}

/// Of boxes above so many groups: up to a single one.
std::size_t levels_of(std::size_t groups) {
    std::size_t levels = groups > 0 ? 1 : 0;
    for (; groups > 1; groups = groups_of(groups))
        ++levels;
    return levels;
}

struct Box {
    std::int32_t x_low, x_high, y_low, y_high;
};
Box box_of(const TriangleRecord& t) {
    return {std::min({t.x[0], t.x[1], t.x[2]}), std::max({t.x[0], t.x[1], t.x[2]}),
            std::min({t.y[0], t.y[1], t.y[2]}), std::max({t.y[0], t.y[1], t.y[2]})};
}

constexpr int cell_bits = 13, class_bits = 4;
constexpr int key_bits = 2 * cell_bits + class_bits;

/// Where a triangle stands in the order: large before small, by powers of four; then along a Morton curve of
/// the middles of their boxes. 30 bits.
std::uint64_t order_of(const TriangleRecord& t, std::int32_t steps) {
    const Box b = box_of(t);
    const auto side = static_cast<std::uint64_t>(
        std::max(std::int64_t{b.x_high} - b.x_low, std::int64_t{b.y_high} - b.y_low));
    const int size = std::min(static_cast<int>(std::bit_width(side) + 1) / 2, (1 << class_bits) - 1);
    const auto cell = [&](std::int32_t low, std::int32_t high) {
        const std::int64_t middle = std::clamp<std::int64_t>((std::int64_t{low} + high) / 2, 0, steps - 1);
        return static_cast<std::uint32_t>(middle >> (28 - cell_bits));
    };
    const std::uint64_t smaller = static_cast<std::uint64_t>((1 << class_bits) - 1 - size);
    return smaller << (2 * cell_bits) |
           morton_code<cell_bits>(cell(b.x_low, b.x_high), cell(b.y_low, b.y_high));
}

/// Index and order of every record, sorted: by chunks of records, each of whose digits are counted alone, so
/// that any number of threads scatters to the same places.
class RecordOrder {
  public:
    RecordOrder(CasterScratch& scratch, std::int32_t steps, const Exec& exec)
        : exec_(exec), items_(scratch.items), other_(scratch.other_items) {
        const TriangleSetup& setup = scratch.setup;
        std::vector<std::size_t> first(setup.blocks.size() + 1, 0);
        for (std::size_t b = 0; b < setup.blocks.size(); ++b)
            first[b + 1] = first[b] + setup.blocks[b].count;
        items_.reset(first.back());
        other_.reset(first.back());
        parallel_for(setup.blocks.size(), exec, [&](std::size_t b) {
            const RecordBlock& block = setup.blocks[b];
            for (std::size_t i = 0; i < block.count; ++i) {
                const std::size_t at = block.begin + i;
                items_[first[b] + i] = order_of(setup.records[at], steps) << 32 | at;
            }
        });
        for (int low = 32; low < 32 + key_bits; low += digit_bits)
            sort_digit(low);
    }
    std::size_t size() const { return items_.size(); }
    std::size_t record(std::size_t i) const { return static_cast<std::size_t>(items_[i] & 0xffffffffu); }

  private:
    static constexpr int digit_bits = 10;
    static constexpr std::size_t digits = 1 << digit_bits;

    void sort_digit(int low) {
        const std::size_t n = items_.size(), chunks = std::clamp<std::size_t>(n / 16384, 1, 16);
        const auto begin = [&](std::size_t c) { return n * c / chunks; };
        const auto digit = [&](std::uint64_t item) { return (item >> low) & (digits - 1); };
        places_.assign(chunks * digits, 0);
        parallel_for(chunks, exec_, [&](std::size_t c) {
            for (std::size_t i = begin(c); i < begin(c + 1); ++i)
                ++places_[c * digits + digit(items_[i])];
        });
        std::size_t next = 0;
        for (std::size_t d = 0; d < digits; ++d) {
            for (std::size_t c = 0; c < chunks; ++c)
                next += std::exchange(places_[c * digits + d], next);
        }
        parallel_for(chunks, exec_, [&](std::size_t c) {
            for (std::size_t i = begin(c); i < begin(c + 1); ++i)
                other_[places_[c * digits + digit(items_[i])]++] = items_[i];
        });
        std::swap(items_, other_);
    }

    const Exec& exec_;
    Buffer<std::uint64_t>&items_, &other_;
    std::vector<std::size_t> places_;
};

/// From p to the light, not unit: against the light's way, or to its position.
Vec3d way_to_light(const Light& light, Vec3d p) {
    return is_parallel(light.kind) ? -light.direction : light.position - p;
}

/// One view's casters being made.
class Builder {
  public:
    Builder(const Mesh& mesh, const Light& light, const Exec& exec, CasterScratch& scratch)
        : mesh_(mesh), light_(light), exec_(exec), scratch_(scratch) {}

    void run(Casters& casters) const {
        const RecordOrder order(scratch_, casters.view.width * subtexel_one, exec_);
        casters.count = order.size();
        const std::size_t groups = groups_of(casters.count);
        casters.boxes.resize(levels_of(groups));
        if (groups == 0) return;
        casters.triangles.reset(groups * group);
        casters.boxes[0].reset(groups);
        parallel_blocks(groups, 256, exec_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t g = begin; g < end; ++g)
                fill_group(order, g, casters);
        });
        for (std::size_t l = 1; l < casters.boxes.size(); ++l) {
            casters.boxes[l].reset(groups_of(casters.boxes[l - 1].size()));
            bound(casters.boxes[l - 1], casters.boxes[l]);
        }
    }

  private:
    void fill_group(const RecordOrder& order, std::size_t g, Casters& casters) const {
        for (std::size_t k = 0; k < group; ++k) {
            const std::size_t i = g * group + k;
            CasterBoxes& boxes = casters.boxes[0][g];
            if (i >= order.size()) {
                casters.triangles[i] = {};
                set_empty(boxes, k);
                continue;
            }
            const TriangleRecord& t = scratch_.setup.records[order.record(i)];
            casters.triangles[i] = caster(t);
            const Box b = box_of(t);
            boxes.x_low[k] = b.x_low;
            boxes.x_high[k] = b.x_high;
            boxes.y_low[k] = b.y_low;
            boxes.y_high[k] = b.y_high;
            boxes.z_low[k] = t.zmin - depth_error;
            boxes.z_high[k] = t.zmax + depth_error;
        }
    }

    static void set_empty(CasterBoxes& boxes, std::size_t k) {
        boxes.x_low[k] = boxes.y_low[k] = most_step;
        boxes.x_high[k] = boxes.y_high[k] = -most_step;
        boxes.z_low[k] = std::numeric_limits<float>::infinity();
        boxes.z_high[k] = -std::numeric_limits<float>::infinity();
    }

    CasterTriangle caster(const TriangleRecord& t) const {
        CasterTriangle c{};
        std::copy_n(t.x, 3, c.x);
        std::copy_n(t.y, 3, c.y);
        c.face = mesh_.face[t.triangle];
        c.triangle = t.triangle;
        const Plane& plane = mesh_.faces[c.face];
        // Turned to the light. A plane through the light, or along its way, hides nothing.
        const Vec3d on_plane = plane.n * -plane.d;
        const double facing = dot(plane.n, way_to_light(light_, on_plane));
        const double side = facing > 0 ? 1.0 : (facing < 0 ? -1.0 : 0.0);
        set(c.n, plane.n * side);
        c.d = plane.d * side;
        return c;
    }

    void bound(const Buffer<CasterBoxes>& below, Buffer<CasterBoxes>& above) const {
        for (std::size_t i = 0; i < above.size() * group; ++i) {
            CasterBoxes& to = above[i / group];
            const std::size_t k = i % group;
            set_empty(to, k);
            if (i >= below.size()) continue;
            const CasterBoxes& from = below[i];
            to.x_low[k] = *std::min_element(from.x_low, from.x_low + group);
            to.x_high[k] = *std::max_element(from.x_high, from.x_high + group);
            to.y_low[k] = *std::min_element(from.y_low, from.y_low + group);
            to.y_high[k] = *std::max_element(from.y_high, from.y_high + group);
            to.z_low[k] = *std::min_element(from.z_low, from.z_low + group);
            to.z_high[k] = *std::max_element(from.z_high, from.z_high + group);
        }
    }

    const Mesh& mesh_;
    const Light& light_;
    const Exec& exec_;
    CasterScratch& scratch_;
};

}  // namespace

std::int64_t Casters::bytes() const {
    std::size_t bytes = triangles.size() * sizeof(CasterTriangle);
    for (const auto& level : boxes)
        bytes += level.size() * sizeof(CasterBoxes);
    return static_cast<std::int64_t>(bytes);
}

std::vector<Casters> build_casters(const Mesh& mesh, const Light& light, const Exec& exec,
                                   CasterScratch& scratch, const std::atomic<bool>* cancel) {
    // Lamps' views a 2,048th wider than what they are for: which of six a point belongs to is found in
    // floats.
    const ShadowViewParams params{exact_view_texels, 1023};
    const Bounds box = is_parallel(light.kind) ? caster_box(mesh, light.direction) : Bounds{};
    std::vector<Casters> all;
    for (const LightView& view : fitted_shadow_views(light, params, box)) {
        if (stopped(cancel)) return {};
        Casters& casters = all.emplace_back();
        if (!scratch.spare.empty()) {
            casters = std::move(scratch.spare.back());
            scratch.spare.pop_back();
        }
        casters.view = view;
        SetupParams setup;
        setup.only_casters = true;
        setup.centre_samples_only = false;
        setup.depth_planes = false;
        // Another part of a light with a size sees what its middle sees along its plane.
        setup.keep_flat = has_size(light);
        setup_triangles(mesh, view, setup, exec, scratch.setup);
        Builder(mesh, light, exec, scratch).run(casters);
    }
    return all;
}

std::int64_t casters_bytes(std::int64_t triangles) {
    // A sixteenth of a group of boxes each, and a fifteenth of that for all levels above.
    constexpr std::int64_t boxes = sizeof(CasterBoxes) / group;
    return triangles * (std::int64_t{sizeof(CasterTriangle)} + boxes + boxes / 15 + 1);
}

std::int64_t casters_sorting_bytes(std::int64_t triangles) {
    return triangles * 2 * std::int64_t{sizeof(std::uint64_t)};
}

ExactLight exact_light(const Light& light, std::span<const Casters> casters, const Mesh& mesh,
                       const CameraRays& rays) {
    CHECK(casters.size() == 1 || casters.size() == 6);
    ExactLight e;
    e.views = static_cast<std::int32_t>(casters.size());
    for (std::size_t i = 0; i < casters.size(); ++i) {
        const Casters& c = casters[i];
        ExactView& v = e.view[i];
        std::copy_n(&c.view.to_map.m[0][0], 16, &v.to_map[0][0]);
        v.triangles = c.triangles.data();
        v.count = static_cast<std::int64_t>(c.count);
        v.levels = static_cast<std::int32_t>(c.boxes.size());
        CHECK(v.levels <= most_caster_levels);
        for (std::size_t l = 0; l < c.boxes.size(); ++l)
            v.boxes[l] = c.boxes[l].data();
        v.steps = c.view.width * subtexel_one;
        v.perspective = c.view.perspective;
        v.near_w = c.view.near_w;
        v.step_m = texel_size_m(c.view) / subtexel_one;
        const auto& depth = c.view.to_map.m[2];
        if (!v.perspective) v.depth_m = 1 / length(Vec3d{depth[0], depth[1], depth[2]});
    }
    e.directional = is_parallel(light.kind);
    set(e.to_light, to_float(-normalize(light.direction)));
    const Vec3d eye{rays.eye[0], rays.eye[1], rays.eye[2]};
    set(e.position, to_float(light.position - eye));
    std::copy_n(rays.eye, 3, e.eye);
    e.positions = mesh.positions.empty() ? nullptr : &mesh.positions[0].x;
    e.corners = mesh.triangles.empty() ? nullptr : &mesh.triangles[0].v[0];
    // A pixel's side, everywhere or at distance 1.
    const auto side = [](const double(&x)[3], const double(&y)[3]) {
        return std::max(length(Vec3d{x[0], x[1], x[2]}), length(Vec3d{y[0], y[1], y[2]})) / subtexel_one;
    };
    if (rays.perspective) {
        std::copy_n(rays.eye, 3, e.viewer);
        e.snapping_per_m = static_cast<float>(side(rays.dir_x, rays.dir_y));
    } else {
        for (int k = 0; k < 3; ++k)
            e.viewer[k] = -rays.dir0[k];
        e.viewer[3] = 0;
        e.snapping_m = static_cast<float>(side(rays.origin_x, rays.origin_y));
    }
    return e;
}

}  // namespace obscura
