// The only door to SuiteSparse's CHOLMOD.
//
// Chen, Davis, Hager, Rajamanickam, "Algorithm 887: CHOLMOD, Supernodal Sparse Cholesky Factorization and
// Update/Downdate", ACM TOMS 2008.

#include <cholmod.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "bench/stereo/peers.h"
#include "core/stopwatch.h"

namespace obscura {
namespace {

struct CholmodSession {
    cholmod_common common{};
    CholmodSession() {
        cholmod_start(&common);
        common.supernodal = CHOLMOD_SUPERNODAL;
        common.print = 0;
    }
    ~CholmodSession() { cholmod_finish(&common); }
    CholmodSession(const CholmodSession&) = delete;
    CholmodSession& operator=(const CholmodSession&) = delete;
};

/// Columns of the lower triangle: of a symmetric matrix the rows' entries from the diagonal on.
cholmod_sparse* lower_triangle(const StereoMatrix& matrix, cholmod_common& common) {
    const auto size = static_cast<std::size_t>(matrix.size);
    const std::size_t most = (matrix.columns.size() + size) / 2;
    cholmod_sparse* lower = cholmod_allocate_sparse(size, size, most, 1, 1, -1, CHOLMOD_REAL, &common);
    if (lower == nullptr) return nullptr;
    auto* const starts = static_cast<int*>(lower->p);
    auto* const rows = static_cast<int*>(lower->i);
    auto* const values = static_cast<double*>(lower->x);
    int count = 0;
    for (int column = 0; column < matrix.size; ++column) {
        starts[column] = count;
        const auto c = static_cast<std::size_t>(column);
        for (auto e = static_cast<std::size_t>(matrix.starts[c]);
             e < static_cast<std::size_t>(matrix.starts[c + 1]); ++e) {
            if (matrix.columns[e] < column) continue;
            rows[count] = matrix.columns[e];
            values[count++] = matrix.values[e];
        }
    }
    starts[matrix.size] = count;
    return lower;
}

/// Adds what the factor makes of the residual.
bool solve_once(const StereoMatrix& matrix, cholmod_factor* factor, cholmod_common& common,
                std::vector<double>& x) {
    const std::vector<double> residual = matrix_residual(matrix, x);
    cholmod_dense* right = cholmod_allocate_dense(residual.size(), 1, residual.size(), CHOLMOD_REAL, &common);
    if (right == nullptr) return false;
    std::copy(residual.begin(), residual.end(), static_cast<double*>(right->x));
    cholmod_dense* step = cholmod_solve(CHOLMOD_A, factor, right, &common);
    for (std::size_t i = 0; step != nullptr && i < x.size(); ++i)
        x[i] += static_cast<const double*>(step->x)[i];
    const bool solved = step != nullptr;
    cholmod_free_dense(&step, &common);
    cholmod_free_dense(&right, &common);
    return solved;
}

}  // namespace

DirectSolution solve_by_cholmod(const StereoMatrix& matrix) {
    CholmodSession session;
    DirectSolution solution;
    cholmod_sparse* lower = lower_triangle(matrix, session.common);
    if (lower == nullptr) return {{}, 0, 0, 0, "out of memory"};
    const Stopwatch whole;
    cholmod_factor* factor = cholmod_analyze(lower, &session.common);
    const bool factorised = factor != nullptr && cholmod_factorize(lower, factor, &session.common) != 0 &&
                            session.common.status == CHOLMOD_OK;
    const Stopwatch after_factor;
    solution.x.assign(static_cast<std::size_t>(matrix.size), 0.0);
    if (!factorised || !solve_once(matrix, factor, session.common, solution.x) ||
        !solve_once(matrix, factor, session.common, solution.x))
        solution.problem = fmt::format("CHOLMOD failed with status {}", session.common.status);
    solution.ms = 1e3 * whole.seconds();
    solution.solve_ms = 1e3 * after_factor.seconds();
    if (factor != nullptr && factor->is_super != 0)
        solution.factor_mib = static_cast<double>(factor->xsize) * sizeof(double) / (1 << 20);
    cholmod_free_factor(&factor, &session.common);
    cholmod_free_sparse(&lower, &session.common);
    return solution;
}

std::string version_of_cholmod() {
    int version[3] = {0, 0, 0};
    cholmod_version(version);
    std::string blas = "unknown BLAS";
    Dl_info info{};
    const void* const dgemm = dlsym(RTLD_DEFAULT, "dgemm_");
    if (dgemm != nullptr && dladdr(dgemm, &info) != 0 && info.dli_fname != nullptr) {
        std::error_code error;
        const auto file = std::filesystem::canonical(info.dli_fname, error);
        if (!error) blas = (file.parent_path().filename() / file.filename()).string();
    }
    return fmt::format("{}.{}.{} on {}", version[0], version[1], version[2], blas);
}

}  // namespace obscura
