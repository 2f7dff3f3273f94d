// The only door to Eigen.
//
// Eigen 3.4, modules IterativeLinearSolvers and SparseCholesky. Its conjugate gradients have no callback: the
// preconditioner is wrapped in one that looks at the destination whenever it is asked, once per iteration.

#include <fmt/format.h>
#include <Eigen/Sparse>

#include <chrono>

#include "bench/stereo/peers.h"

namespace obscura {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;
using Clock = std::chrono::steady_clock;

/// Thrown out of Eigen's loop when enough was seen.
struct Seen {};

template <class Inner>
class Watched {
  public:
    using StorageIndex = int;
    enum { ColsAtCompileTime = Eigen::Dynamic, MaxColsAtCompileTime = Eigen::Dynamic };

    template <class M>
    Watched& analyzePattern(const M& m) {
        inner_.analyzePattern(m);
        return *this;
    }
    template <class M>
    Watched& factorize(const M& m) {
        inner_.factorize(m);
        return *this;
    }
    template <class M>
    Watched& compute(const M& m) {
        inner_.compute(m);
        return *this;
    }
    template <class Right>
    Eigen::VectorXd solve(const Right& r) const {
        watch();
        return inner_.solve(r);
    }
    Eigen::ComputationInfo info() { return inner_.info(); }

    std::function<void()> watch;

  private:
    Inner inner_;
};

Eigen::Map<const Matrix> mapped(const StereoMatrix& m) {
    return {m.size,          m.size,           static_cast<Eigen::Index>(m.columns.size()),
            m.starts.data(), m.columns.data(), m.values.data()};
}

Eigen::Map<const Eigen::VectorXd> mapped(const std::vector<double>& v) {
    return {v.data(), static_cast<Eigen::Index>(v.size())};
}

template <class Inner>
std::string watched_cg(const StereoMatrix& matrix, const std::vector<float>& start,
                       const LookAtSolution& look) {
    const Matrix a = mapped(matrix);
    const Eigen::VectorXd b = mapped(matrix.rhs);
    Eigen::VectorXd x =
        Eigen::Map<const Eigen::VectorXf>(start.data(), static_cast<Eigen::Index>(start.size()))
            .cast<double>();
    const Eigen::VectorXd first = x;
    Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper, Watched<Inner>> cg;
    cg.setTolerance(1e-14);
    cg.setMaxIterations(1 << 20);
    int iteration = 0;
    Clock::duration looking{};
    const Clock::time_point began = Clock::now();
    cg.preconditioner().watch = [&] {
        const Clock::time_point now = Clock::now();
        const double ms = std::chrono::duration<double, std::milli>(now - began - looking).count();
        if (look(iteration++, ms, x.data())) throw Seen{};
        looking += Clock::now() - now;
    };
    cg.compute(a);
    if (cg.info() != Eigen::Success) return "Eigen could not make the preconditioner";
    try {
        x = cg.solveWithGuess(b, first);
    } catch (const Seen&) {
        return "";
    }
    return cg.info() == Eigen::Success ? "" : "Eigen did not converge";
}

}  // namespace

DirectSolution solve_by_ldlt(const StereoMatrix& matrix) {
    const Eigen::SparseMatrix<double> a = mapped(matrix);  // symmetric: columns are rows
    const Eigen::VectorXd b = mapped(matrix.rhs);
    DirectSolution solution;
    const Clock::time_point start = Clock::now();
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(a);
    if (factor.info() != Eigen::Success) solution.problem = "Eigen could not factorise";
    const Clock::time_point factorised = Clock::now();
    Eigen::VectorXd x = factor.solve(b);
    x += factor.solve(b - a * x);
    const Clock::time_point end = Clock::now();
    solution.ms = std::chrono::duration<double, std::milli>(end - start).count();
    solution.solve_ms = std::chrono::duration<double, std::milli>(end - factorised).count();
    solution.x.assign(x.data(), x.data() + x.size());
    return solution;
}

std::string version_of_eigen() {
    return fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
}

std::string solve_by_cg(const StereoMatrix& matrix, CgPreconditioner preconditioner,
                        const std::vector<float>& start, const LookAtSolution& look) {
    if (preconditioner == CgPreconditioner::diagonal)
        return watched_cg<Eigen::DiagonalPreconditioner<double>>(matrix, start, look);
    return watched_cg<Eigen::IncompleteCholesky<double>>(matrix, start, look);
}

}  // namespace obscura
