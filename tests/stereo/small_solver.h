#pragma once
// The minimiser of a small system by conjugate gradients in double: an oracle that shares nothing with the
// solvers but the definition of the energy in stereo/disparity_system.h.

#include <cmath>
#include <vector>

#include "stereo/disparity_system.h"

namespace obscura {

class SmallSolver {
  public:
    explicit SmallSolver(const DisparitySystem& s) : s_(s), diagonal_(s.original.pixels.size(), 0) {
        const auto at = [&](int x, int y) { return static_cast<std::size_t>(y * s.width() + x); };
        right_.assign(diagonal_.size(), 0);
        for (int y = 0; y < s.height(); ++y) {
            for (int x = 0; x < s.width(); ++x) {
                if (s.valid(x, y) == 0) continue;
                const std::size_t p = at(x, y);
                const double c = 2 * static_cast<double>(s.gradient_weight);
                if (x + 1 < s.width() && s.valid(x + 1, y) != 0)
                    link(p, at(x + 1, y), c, static_cast<double>(s.gradient_x(x, y)));
                if (y + 1 < s.height() && s.valid(x, y + 1) != 0)
                    link(p, at(x, y + 1), c, static_cast<double>(s.gradient_y(x, y)));
                hold(p, static_cast<double>(s.epsilon), static_cast<double>(s.original(x, y)));
                hold(p, static_cast<double>(s.anchor_weight(x, y)),
                     static_cast<double>(s.anchor_value(x, y)));
            }
        }
        for (const MatchingSet& set : s.sets)
            for (const MatchedPixel& m : set.members)
                link(at(set.source_x, set.source_y), at(m.x, m.y), static_cast<double>(set.weight),
                     static_cast<double>(m.target));
    }

    /// Until the residual is 1e-11 of the right side.
    Image<double> minimiser() const {
        const std::size_t n = diagonal_.size();
        std::vector<double> x(n, 0), r = right_, z(n), p(n, 0), q;
        double rho = 1;
        const double goal = 1e-22 * dot(right_, right_);
        for (int k = 0; k < 100000 && dot(r, r) > goal; ++k) {
            for (std::size_t i = 0; i < n; ++i)
                z[i] = diagonal_[i] > 0 ? r[i] / diagonal_[i] : 0;
            const double next = dot(r, z);
            for (std::size_t i = 0; i < n; ++i)
                p[i] = z[i] + (k > 0 ? next / rho : 0) * p[i];
            rho = next;
            q = times(p);
            const double step = rho / dot(p, q);
            for (std::size_t i = 0; i < n; ++i) {
                x[i] += step * p[i];
                r[i] -= step * q[i];
            }
        }
        Image<double> result(s_.width(), s_.height());
        for (std::size_t i = 0; i < n; ++i)
            result.pixels[i] = s_.valid.pixels[i] != 0 ? x[i] : static_cast<double>(s_.start.pixels[i]);
        return result;
    }

  private:
    struct Link {
        std::size_t a, b;
        double weight;
    };
    void link(std::size_t a, std::size_t b, double weight, double wanted) {
        links_.push_back({a, b, weight});
        diagonal_[a] += weight;
        diagonal_[b] += weight;
        right_[a] -= weight * wanted;
        right_[b] += weight * wanted;
    }
    void hold(std::size_t p, double weight, double wanted) {
        diagonal_[p] += weight;
        right_[p] += weight * wanted;
    }
    static double dot(const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i)
            sum += a[i] * b[i];
        return sum;
    }
    std::vector<double> times(const std::vector<double>& x) const {
        std::vector<double> y(x.size());
        for (std::size_t i = 0; i < x.size(); ++i)
            y[i] = diagonal_[i] * x[i];
        for (const Link& l : links_) {
            y[l.a] -= l.weight * x[l.b];
            y[l.b] -= l.weight * x[l.a];
        }
        return y;
    }

    const DisparitySystem& s_;
    std::vector<Link> links_;
    std::vector<double> diagonal_, right_;
};

inline Image<double> small_minimiser(const DisparitySystem& system) {
    return SmallSolver(system).minimiser();
}

}  // namespace obscura
