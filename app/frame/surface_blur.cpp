#include "app/frame/surface_blur.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace obscura {
namespace {

/// A corner of the grid, for one of six directions.
struct Corner {
    std::int64_t x, y, z;
    int facing;
    friend bool operator==(const Corner&, const Corner&) = default;
};

std::uint64_t hash_of(const Corner& c) {
    std::uint64_t h = static_cast<std::uint64_t>(c.facing);
    for (const std::int64_t v : {c.x, c.y, c.z}) {
        h = (h ^ static_cast<std::uint64_t>(v)) * 0x9e3779b97f4a7c15u;
        h ^= h >> 29;
    }
    return h;
}

/// Corners that something touches: places are handed out in the order of their first touch. Open addressing
/// (D. Knuth, The Art of Computer Programming 3, 6.4, algorithm L).
class Corners {
  public:
    explicit Corners(std::size_t most) : slot_(std::bit_ceil(2 * most + 1), empty) {}

    std::uint32_t place(const Corner& c) {
        const std::size_t mask = slot_.size() - 1;
        std::size_t at = hash_of(c) & mask;
        for (; slot_[at] != empty; at = (at + 1) & mask) {
            if (corners_[slot_[at]] == c) return slot_[at];
        }
        if (2 * corners_.size() >= slot_.size()) {
            grow();
            return place(c);
        }
        slot_[at] = static_cast<std::uint32_t>(corners_.size());
        corners_.push_back(c);
        return slot_[at];
    }
    std::size_t count() const { return corners_.size(); }

  private:
    static constexpr std::uint32_t empty = 0xffffffffu;

    void grow() {
        std::vector<std::uint32_t> larger(2 * slot_.size(), empty);
        const std::size_t mask = larger.size() - 1;
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            std::size_t at = hash_of(corners_[i]) & mask;
            while (larger[at] != empty)
                at = (at + 1) & mask;
            larger[at] = static_cast<std::uint32_t>(i);
        }
        slot_.swap(larger);
    }

    std::vector<std::uint32_t> slot_;
    std::vector<Corner> corners_;
};

/// The eight corners around a patch and its shares of them.
struct Around {
    std::uint32_t corner[8];
    float share[8];
};

Around around(const BlurPatch& patch, double spacing, Corners& corners) {
    const double at[3] = {patch.p.x / spacing, patch.p.y / spacing, patch.p.z / spacing};
    std::int64_t low[3];
    double part[3];
    for (int k = 0; k < 3; ++k) {
        const double whole = std::floor(std::clamp(at[k], -0x1p60, 0x1p60));
        low[k] = static_cast<std::int64_t>(whole);
        part[k] = std::clamp(at[k] - whole, 0.0, 1.0);
    }
    Around a{};
    for (int i = 0; i < 8; ++i) {
        const int x = i & 1, y = i >> 1 & 1, z = i >> 2;
        a.corner[i] = corners.place({low[0] + x, low[1] + y, low[2] + z, patch.facing});
        const auto share = [&](int k, int upper) { return upper == 1 ? part[k] : 1 - part[k]; };
        a.share[i] = static_cast<float>(share(0, x) * share(1, y) * share(2, z));
    }
    return a;
}

}  // namespace

int facing_of(Vec3d n) {
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    if (y >= x && y >= z) return n.y >= 0 ? 0 : 1;
    if (x >= z) return n.x >= 0 ? 2 : 3;
    return n.z >= 0 ? 4 : 5;
}

std::vector<Vec3f> mean_around(const std::vector<BlurPatch>& patches, const std::vector<Vec3f>& values,
                               double radius_m) {
    Corners corners(patches.size());
    struct Sum {
        Vec3f value;
        float weight = 0;
    };
    std::vector<Sum> sums;
    std::vector<Around> places;
    places.reserve(patches.size());
    for (std::size_t i = 0; i < patches.size(); ++i) {
        const Around& a = places.emplace_back(around(patches[i], radius_m, corners));
        sums.resize(corners.count());
        for (int k = 0; k < 8; ++k) {
            const float weight = a.share[k] * patches[i].area_m2;
            Sum& sum = sums[a.corner[k]];
            sum.value = sum.value + values[i] * weight;
            sum.weight += weight;
        }
    }
    std::vector<Vec3f> means(patches.size());
    for (std::size_t i = 0; i < patches.size(); ++i) {
        const Around& a = places[i];
        Vec3f value{0, 0, 0};
        float weight = 0;
        for (int k = 0; k < 8; ++k) {
            value = value + sums[a.corner[k]].value * a.share[k];
            weight += sums[a.corner[k]].weight * a.share[k];
        }
        means[i] = weight > 0 ? value * (1 / weight) : values[i];
    }
    return means;
}

}  // namespace obscura
