#include "stereo/solver/system_parts.h"

#include <algorithm>
#include <cstring>
#include <tuple>

#include "core/union_find.h"
#include "stereo/solver/dense_cholesky.h"

namespace obscura {
namespace {

/// Root of every valid pixel's part.
Image<std::uint32_t> labels(const DisparitySystem& s) {
    const int width = s.width(), height = s.height();
    const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * width + x); };
    UnionFind sets(s.valid.pixels.size());
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (s.valid(x, y) == 0) continue;
            if (x > 0 && s.valid(x - 1, y) != 0) sets.unite(at(x - 1, y), at(x, y));
            if (y > 0 && s.valid(x, y - 1) != 0) sets.unite(at(x, y - 1), at(x, y));
        }
    }
    for (const MatchingSet& set : s.sets) {
        if (s.valid(set.source_x, set.source_y) == 0) continue;
        for (const MatchedPixel& p : set.members) {
            if (s.valid(p.x, p.y) != 0) sets.unite(at(set.source_x, set.source_y), at(p.x, p.y));
        }
    }
    Image<std::uint32_t> label(width, height);
    for (std::size_t i = 0; i < label.pixels.size(); ++i)
        label.pixels[i] = sets.root(static_cast<std::uint32_t>(i));
    return label;
}

template <class T>
Image<T> cut(const Image<T>& image, const SystemPart& p) {
    if (p.x1 - p.x0 == image.width && p.y1 - p.y0 == image.height) return image;
    Image<T> out(p.x1 - p.x0, p.y1 - p.y0);
    for (int y = 0; y < out.height; ++y)
        std::copy_n(image.row(p.y0 + y) + p.x0, out.width, out.row(y));
    return out;
}

}  // namespace

SystemParts system_parts(const DisparitySystem& s) {
    SystemParts out;
    if (std::memchr(s.valid.pixels.data(), 0, s.valid.pixels.size()) == nullptr) {
        out.parts.push_back(
            {0, 0, s.width(), s.height(), static_cast<std::int64_t>(s.valid.pixels.size()), 0});
        return out;
    }
    out.label = labels(s);
    constexpr std::uint32_t none = 0xffffffffu;
    std::vector<std::uint32_t> index(s.valid.pixels.size(), none);
    for (int y = 0; y < s.height(); ++y) {
        for (int x = 0; x < s.width(); ++x) {
            if (s.valid(x, y) == 0) continue;
            std::uint32_t& i = index[out.label(x, y)];
            if (i == none) {
                i = static_cast<std::uint32_t>(out.parts.size());
                out.parts.push_back({x, y, x, y, 0, out.label(x, y)});
            }
            SystemPart& p = out.parts[i];
            p.x0 = std::min(p.x0, x);
            p.x1 = std::max(p.x1, x + 1);
            p.y1 = y + 1;
            ++p.pixels;
        }
    }
    std::sort(out.parts.begin(), out.parts.end(), [](const SystemPart& a, const SystemPart& b) {
        return std::tuple(-a.pixels, a.label) < std::tuple(-b.pixels, b.label);
    });
    return out;
}

DisparitySystem part_system(const DisparitySystem& s, const SystemParts& parts, const SystemPart& part) {
    DisparitySystem out;
    out.original = cut(s.original, part);
    out.start = cut(s.start, part);
    out.gradient_x = cut(s.gradient_x, part);
    out.gradient_y = cut(s.gradient_y, part);
    out.anchor_weight = cut(s.anchor_weight, part);
    out.anchor_value = cut(s.anchor_value, part);
    out.valid = cut(s.valid, part);
    out.gradient_weight = s.gradient_weight;
    out.epsilon = s.epsilon;
    for (int y = 0; y < out.height(); ++y) {
        for (int x = 0; x < out.width(); ++x) {
            if (parts.label(x + part.x0, y + part.y0) != part.label) out.valid(x, y) = 0;
        }
    }
    for (const MatchingSet& set : s.sets) {
        if (s.valid(set.source_x, set.source_y) == 0) continue;
        if (parts.label(set.source_x, set.source_y) != part.label) continue;
        MatchingSet& moved = out.sets.emplace_back(set);
        moved.source_x -= part.x0;
        moved.source_y -= part.y0;
        std::erase_if(moved.members, [&](const MatchedPixel& p) { return s.valid(p.x, p.y) == 0; });
        for (MatchedPixel& p : moved.members) {
            p.x -= part.x0;
            p.y -= part.y0;
        }
    }
    return out;
}

namespace {

/// The dense matrix of a part's pixels, which `index` numbers from 0; -1 for all others.
std::vector<double> dense_matrix(const DisparitySystem& s, const Image<std::int32_t>& index, std::size_t n) {
    std::vector<double> matrix(n * n, 0.0);
    const auto tie = [&](int x, int y, int x2, int y2, double weight) {
        if (index(x, y) < 0 || index(x2, y2) < 0 || index(x, y) == index(x2, y2)) return;
        const auto a = static_cast<std::size_t>(index(x, y)), b = static_cast<std::size_t>(index(x2, y2));
        matrix[a * n + a] += weight;
        matrix[b * n + b] += weight;
        matrix[a * n + b] -= weight;
        matrix[b * n + a] -= weight;
    };
    const double edge = 2.0 * static_cast<double>(s.gradient_weight);
    for (int y = 0; y < s.height(); ++y) {
        for (int x = 0; x < s.width(); ++x) {
            if (index(x, y) < 0) continue;
            const auto i = static_cast<std::size_t>(index(x, y));
            matrix[i * n + i] += static_cast<double>(s.epsilon) + static_cast<double>(s.anchor_weight(x, y));
            if (x + 1 < s.width()) tie(x, y, x + 1, y, edge);
            if (y + 1 < s.height()) tie(x, y, x, y + 1, edge);
        }
    }
    for (const MatchingSet& set : s.sets) {
        for (const MatchedPixel& p : set.members)
            tie(set.source_x, set.source_y, p.x, p.y, static_cast<double>(set.weight));
    }
    return matrix;
}

}  // namespace

void minimise_part(const DisparitySystem& s, const SystemParts& parts, const SystemPart& part,
                   DisparityMap& x) {
    const DisparitySystem own = part_system(s, parts, part);
    Image<std::int32_t> index(own.width(), own.height(), -1);
    std::vector<std::pair<int, int>> pixels;
    for (int y = 0; y < own.height(); ++y) {
        for (int i = 0; i < own.width(); ++i) {
            if (own.valid(i, y) == 0) continue;
            index(i, y) = static_cast<std::int32_t>(pixels.size());
            pixels.emplace_back(i, y);
        }
    }
    const std::size_t n = pixels.size();
    std::vector<double> matrix = dense_matrix(own, index, n), right;
    const Image<double> b = residual(own, DisparityMap(own.width(), own.height()));
    for (const auto& [i, y] : pixels)
        right.push_back(b(i, y));
    factor_cholesky(static_cast<int>(n), matrix);
    solve_cholesky(static_cast<int>(n), matrix, right);
    for (std::size_t i = 0; i < n; ++i)
        x(part.x0 + pixels[i].first, part.y0 + pixels[i].second) = static_cast<float>(right[i]);
}

}  // namespace obscura
