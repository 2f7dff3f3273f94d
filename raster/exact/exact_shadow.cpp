#include "raster/exact/exact_shadow.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/morton.h"
#include "raster/depth_tile.h"

namespace obscura {
namespace {

constexpr int cell_bits = 10, view_bits = 3;

}  // namespace

ExactWork::ExactWork(std::size_t most_points)
    : x_(most_points),
      y_(most_points),
      z_(most_points),
      rounding_(most_points),
      point_(most_points),
      order_(most_points),
      other_order_(most_points),
      key_(most_points),
      other_key_(most_points),
      view_(most_points) {
    samples_.x = x_.data();
    samples_.y = y_.data();
    samples_.z = z_.data();
    samples_.rounding = rounding_.data();
    samples_.point = point_.data();
    samples_.view = view_.data();
}

void ExactWork::shadows(const ExactPoints& points, const ExactLight& light, Isa isa, std::uint32_t* lit,
                        ExactCounts& counts) {
    OBSCURA_DISPATCH(isa, exact_locate, points, light, samples_, lit, counts);
    if (samples_.count == 0) return;
    sort_samples(light.views);
    OBSCURA_DISPATCH(isa, exact_darken, points, light, samples_, order_.data(), lit, counts);
}

void ExactWork::shadows(const ExactPoints& points, const ExactSoft& light, Isa isa, std::uint32_t* lit,
                        std::size_t stride, ExactCounts& counts) {
    for (std::int32_t p = 0; p < 16 * light.groups; ++p) {
        if (p % 16 < light.parts[p / 16].count)
            std::fill_n(lit + static_cast<std::size_t>(p) * stride, points.count / 16, 0u);
    }
    OBSCURA_DISPATCH(isa, exact_reach, points, light.middle, light.spread, samples_);
    if (samples_.count == 0) return;
    sort_samples(1);
    OBSCURA_DISPATCH(isa, exact_soft, points, light, samples_, order_.data(), lit,
                     static_cast<std::int32_t>(stride), counts);
}

void ExactWork::nearest(const ExactPoints& points, const ExactLight& light, Isa isa, std::uint32_t* lit,
                        const ExactHits& hits, ExactCounts& counts) {
    CHECK(light.directional, "the nearest triangle is known for parallel light alone");
    OBSCURA_DISPATCH(isa, exact_locate_nearest, points, light, samples_, lit, hits, counts);
    if (samples_.count == 0) return;
    sort_samples(light.views);
    OBSCURA_DISPATCH(isa, exact_nearest, points, light, samples_, order_.data(), lit, hits, counts);
}

float ExactWork::widest_penumbra(const ExactPoints& points, const ExactLight& light,
                                 const ExactSpread& spread, float stop_px, Isa isa, ExactCounts& counts) {
    float widest_px = 0;
    OBSCURA_DISPATCH(isa, exact_reach, points, light, spread, samples_);
    if (samples_.count == 0) return widest_px;
    sort_samples(light.views);
    OBSCURA_DISPATCH(isa, exact_widest, points, light, spread, samples_, order_.data(), stop_px, widest_px,
                     counts);
    return widest_px;
}

/// View by view along a Morton curve of square cells, of which the longer side of what the samples span has
/// up to 2^cell_bits.
void ExactWork::sort_samples(int views) {
    const auto n = static_cast<std::size_t>(samples_.count);
    const auto [x_low, x_high] = std::minmax_element(x_.data(), x_.data() + n);
    const auto [y_low, y_high] = std::minmax_element(y_.data(), y_.data() + n);
    const std::int32_t x0 = *x_low, y0 = *y_low;
    const auto span = static_cast<std::uint32_t>(std::max(*x_high - x0, *y_high - y0));
    const int shift = std::max(static_cast<int>(std::bit_width(span)) - cell_bits, 0);
    for (std::size_t i = 0; i < n; ++i) {
        const auto cell = [&](std::int32_t at, std::int32_t low) {
            return static_cast<std::uint32_t>(at - low) >> shift;
        };
        key_[i] = static_cast<std::uint32_t>(std::uint64_t{view_[i]} << (2 * cell_bits) |
                                             morton_code<cell_bits>(cell(x_[i], x0), cell(y_[i], y0)));
        order_[i] = static_cast<std::uint32_t>(i);
    }
    sort_digit(0);
    sort_digit(cell_bits);
    if (views > 1) sort_digit(2 * cell_bits);
}

void ExactWork::sort_digit(int low) {
    constexpr std::uint32_t digits = 1u << cell_bits;
    static_assert(view_bits <= cell_bits);
    const auto n = static_cast<std::size_t>(samples_.count);
    std::uint32_t place[digits] = {};
    for (std::size_t i = 0; i < n; ++i)
        ++place[key_[i] >> low & (digits - 1)];
    std::uint32_t next = 0;
    for (std::uint32_t& p : place)
        next += std::exchange(p, next);
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t to = place[key_[i] >> low & (digits - 1)]++;
        other_key_[to] = key_[i];
        other_order_[to] = order_[i];
    }
    std::swap(key_, other_key_);
    std::swap(order_, other_order_);
}

void exact_positions(const SurfaceBlock& block, const Mesh& mesh, Vec3d eye, double* px, double* py,
                     double* pz, std::uint32_t* face) {
    for (std::size_t i = 0; i < block_samples; ++i) {
        Vec3d p = eye + to_double(Vec3f{block.px[i], block.py[i], block.pz[i]});
        face[i] = no_triangle;
        if (const std::uint32_t triangle = block.triangle[i]; triangle != no_triangle) {
            face[i] = mesh.face[triangle];
            const Plane& plane = mesh.faces[face[i]];
            p = p - plane.n * (dot(plane.n, p) + plane.d);
        }
        px[i] = p.x;
        py[i] = p.y;
        pz[i] = p.z;
    }
}

}  // namespace obscura
