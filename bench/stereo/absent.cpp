// In place of peers that this build lacks.

#include "bench/stereo/peers.h"

namespace obscura {

#ifndef OBSCURA_HAS_CHOLMOD
DirectSolution solve_by_cholmod(const StereoMatrix&) {
    return {{}, 0, 0, 0, "CHOLMOD is absent (package libsuitesparse-dev)"};
}

std::string version_of_cholmod() {
    return "";
}
#endif

#ifndef OBSCURA_HAS_EIGEN
DirectSolution solve_by_ldlt(const StereoMatrix&) {
    return {{}, 0, 0, 0, "Eigen is absent (package libeigen3-dev)"};
}

std::string version_of_eigen() {
    return "";
}

std::string solve_by_cg(const StereoMatrix&, CgPreconditioner, const std::vector<float>&,
                        const LookAtSolution&) {
    return "Eigen is absent (package libeigen3-dev)";
}
#endif

}  // namespace obscura
