#include <algorithm>
#include <cmath>

#include "stereo/solver/solver.h"

namespace obscura {
namespace {

/// Sums over the terms of one edit.
struct Misses {
    Unsatisfied of;
    double wanted = 0, reached = 0, terms = 0;

    void add(double want, double get) {
        const double miss = std::abs(get - want);
        wanted += want;
        reached += get;
        terms += 1;
        of.worst_px = std::max(of.worst_px, miss);
        of.pixels += miss > unsatisfied_px ? 1 : 0;
    }
    void tell(std::vector<Unsatisfied>& out) {
        if (static_cast<double>(of.pixels) <= unsatisfied_share * terms) return;
        of.wanted_px = wanted / terms;
        of.reached_px = reached / terms;
        out.push_back(std::move(of));
    }
};

/// The anchor that asks most of `area`'s pixels for something else by more than unsatisfied_px.
std::string opponent(const DisparitySystem& s, const AnchorArea& area) {
    Image<float> wanted(s.width(), s.height());
    Image<std::uint8_t> asked(s.width(), s.height());
    for (const MatchedPixel& p : area.pixels) {
        wanted(p.x, p.y) = p.target;
        asked(p.x, p.y) = 1;
    }
    std::string name;
    std::size_t most = 0;
    for (const AnchorArea& other : s.anchors) {
        if (&other == &area) continue;
        const auto against = [&](const MatchedPixel& p) {
            return asked(p.x, p.y) != 0 && std::abs(static_cast<double>(p.target) -
                                                    static_cast<double>(wanted(p.x, p.y))) > unsatisfied_px;
        };
        const auto count =
            static_cast<std::size_t>(std::count_if(other.pixels.begin(), other.pixels.end(), against));
        if (count <= most) continue;
        most = count;
        name = other.name;
    }
    return name;
}

void gradient_misses(const DisparitySystem& s, const DisparityMap& x, std::vector<Unsatisfied>& out) {
    Misses misses;
    const auto pair = [&](int i, int j, int i2, int j2, float wanted) {
        if (s.valid(i, j) == 0 || s.valid(i2, j2) == 0) return;
        misses.add(static_cast<double>(wanted),
                   static_cast<double>(x(i2, j2)) - static_cast<double>(x(i, j)));
    };
    for (int y = 0; y < s.height(); ++y) {
        for (int i = 0; i < s.width(); ++i) {
            if (i + 1 < s.width()) pair(i, y, i + 1, y, s.gradient_x(i, y));
            if (y + 1 < s.height()) pair(i, y, i, y + 1, s.gradient_y(i, y));
        }
    }
    misses.tell(out);
}

}  // namespace

std::vector<Unsatisfied> unsatisfied(const DisparitySystem& s, const DisparityMap& x) {
    std::vector<Unsatisfied> out;
    for (const AnchorArea& area : s.anchors) {
        Misses misses;
        misses.of.name = area.name;
        for (const MatchedPixel& p : area.pixels) {
            if (s.valid(p.x, p.y) != 0)
                misses.add(static_cast<double>(p.target), static_cast<double>(x(p.x, p.y)));
        }
        if (misses.of.pixels > 0) misses.of.against = opponent(s, area);
        misses.tell(out);
    }
    for (const MatchingSet& set : s.sets) {
        Misses misses;
        misses.of.name = set.name;
        const auto source = static_cast<double>(x(set.source_x, set.source_y));
        for (const MatchedPixel& p : set.members) {
            if (s.valid(p.x, p.y) != 0)
                misses.add(static_cast<double>(p.target), static_cast<double>(x(p.x, p.y)) - source);
        }
        misses.tell(out);
    }
    gradient_misses(s, x, out);
    std::stable_sort(out.begin(), out.end(),
                     [](const Unsatisfied& a, const Unsatisfied& b) { return a.worst_px > b.worst_px; });
    return out;
}

}  // namespace obscura
