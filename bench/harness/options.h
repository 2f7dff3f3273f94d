#pragma once
// What a user asks of a bench.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

struct BenchOptions {
    std::filesystem::path out = "bench/results";
    std::optional<std::filesystem::path> data;  ///< folder of test data; what needs it is left out without
    int runs = 7;                               ///< timed runs of each job, after one warm-up
    std::vector<int> threads = {1, 2};
    bool quick = false;  ///< small pictures of small scenes: a check, not a measurement
    std::string scene;   ///< only subjects whose name contains this
    std::string part;    ///< only this part of a bench that has parts; empty: all
    /// One line of progress or result.
    std::function<void(const std::string&)> say = [](const std::string&) {};
};

}  // namespace obscura
