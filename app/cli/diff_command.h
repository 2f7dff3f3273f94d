#pragma once
// obscura diff A B: how far apart two picture files are.

#include <filesystem>
#include <optional>

#include "app/cli/command.h"
#include "core/file_output.h"
#include "core/isa.h"

namespace obscura {

struct DiffOptions {
    std::filesystem::path a, b;     ///< two PNG or two PFM files of the same size
    std::optional<double> fail;     ///< exit 10 when the largest difference exceeds it
    double threshold = 0.0;         ///< pixels beyond it are counted
    std::filesystem::path picture;  ///< difference picture (PNG), empty = none
    Existing existing = Existing::refuse;
    Exec exec;
};

/// Prints size, max, mean, PSNR, SSIM and the count beyond the threshold to stdout; differences are in codes
/// 0..255 (PNG; 0..65535 when either has 16 bits; alpha counts when either picture uses it) or in the values
/// of the file (PFM; PSNR and SSIM refer to the range of A). Returns 0, or 10 when beyond `fail`. Throws
/// InputError when the files are not comparable, UsageError for a negative or NaN fail or threshold,
/// OutputError.
int diff_command(const DiffOptions& options);

/// The command line of it.
int run_diff(const Arguments& arguments);

}  // namespace obscura
