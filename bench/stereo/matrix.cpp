#include "bench/stereo/matrix.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace obscura {
namespace {

/// An entry above the diagonal or below it.
struct Entry {
    int row, column;
    double value;
};

/// Collects terms weight * (x_b - x_a - difference)^2 and weight * (x_a - value)^2.
struct Terms {
    std::vector<double> diagonal, rhs;
    std::vector<Entry> entries;

    void tie(int a, int b, double weight, double difference) {
        at(diagonal, a) += weight;
        at(diagonal, b) += weight;
        at(rhs, a) -= weight * difference;
        at(rhs, b) += weight * difference;
        entries.push_back({a, b, -weight});
        entries.push_back({b, a, -weight});
    }
    void hold(int a, double weight, double value) {
        at(diagonal, a) += weight;
        at(rhs, a) += weight * value;
    }
    static double& at(std::vector<double>& v, int i) { return v[static_cast<std::size_t>(i)]; }
};

double wide(float v) {
    return static_cast<double>(v);
}

void add_pixels(const DisparitySystem& s, Terms& terms) {
    const double tie = 2 * wide(s.gradient_weight);
    for (int y = 0; y < s.height(); ++y) {
        for (int x = 0; x < s.width(); ++x) {
            const int i = y * s.width() + x;
            if (s.valid(x, y) == 0) {
                terms.hold(i, 1, wide(s.start(x, y)));
                continue;
            }
            terms.hold(i, wide(s.epsilon), wide(s.original(x, y)));
            if (s.anchor_weight(x, y) > 0)
                terms.hold(i, wide(s.anchor_weight(x, y)), wide(s.anchor_value(x, y)));
            if (x + 1 < s.width() && s.valid(x + 1, y) != 0)
                terms.tie(i, i + 1, tie, wide(s.gradient_x(x, y)));
            if (y + 1 < s.height() && s.valid(x, y + 1) != 0)
                terms.tie(i, i + s.width(), tie, wide(s.gradient_y(x, y)));
        }
    }
}

void add_sets(const DisparitySystem& s, Terms& terms) {
    for (const MatchingSet& set : s.sets) {
        if (s.valid(set.source_x, set.source_y) == 0) continue;
        const int source = set.source_y * s.width() + set.source_x;
        for (const MatchedPixel& p : set.members) {
            const int i = p.y * s.width() + p.x;
            if (s.valid(p.x, p.y) != 0 && i != source) terms.tie(source, i, wide(set.weight), wide(p.target));
        }
    }
}

/// Sorts by row and column; equal places add up.
std::vector<Entry> merged(std::vector<Entry> entries) {
    const auto place = [](const Entry& e) { return std::pair(e.row, e.column); };
    std::sort(entries.begin(), entries.end(),
              [&](const Entry& a, const Entry& b) { return place(a) < place(b); });
    std::size_t kept = 0;
    for (const Entry& e : entries) {
        if (kept > 0 && place(entries[kept - 1]) == place(e))
            entries[kept - 1].value += e.value;
        else
            entries[kept++] = e;
    }
    entries.resize(kept);
    return entries;
}

}  // namespace

StereoMatrix stereo_matrix(const DisparitySystem& system) {
    const auto unknowns =
        static_cast<std::size_t>(system.width()) * static_cast<std::size_t>(system.height());
    Terms terms{std::vector<double>(unknowns), std::vector<double>(unknowns), {}};
    terms.entries.reserve(4 * unknowns + unknowns / 4);
    add_pixels(system, terms);
    add_sets(system, terms);
    const std::vector<Entry> entries = merged(std::move(terms.entries));
    CHECK(entries.size() + unknowns < static_cast<std::size_t>(std::numeric_limits<int>::max()));

    StereoMatrix matrix;
    matrix.size = static_cast<int>(unknowns);
    matrix.rhs = std::move(terms.rhs);
    matrix.columns.reserve(entries.size() + unknowns);
    matrix.values.reserve(entries.size() + unknowns);
    const auto add = [&](int column, double value) {
        matrix.columns.push_back(column);
        matrix.values.push_back(value);
    };
    auto next = entries.begin();
    for (int row = 0; row < matrix.size; ++row) {
        matrix.starts.push_back(static_cast<int>(matrix.columns.size()));
        for (; next != entries.end() && next->row == row && next->column < row; ++next)
            add(next->column, next->value);
        add(row, Terms::at(terms.diagonal, row));
        for (; next != entries.end() && next->row == row; ++next)
            add(next->column, next->value);
    }
    matrix.starts.push_back(static_cast<int>(matrix.columns.size()));
    return matrix;
}

std::vector<double> matrix_residual(const StereoMatrix& matrix, const std::vector<double>& x) {
    std::vector<double> residual = matrix.rhs;
    for (std::size_t row = 0; row < residual.size(); ++row) {
        const auto begin = static_cast<std::size_t>(matrix.starts[row]);
        const auto end = static_cast<std::size_t>(matrix.starts[row + 1]);
        for (std::size_t e = begin; e < end; ++e)
            residual[row] -= matrix.values[e] * x[static_cast<std::size_t>(matrix.columns[e])];
    }
    return residual;
}

}  // namespace obscura
