#pragma once
// Counts and sizes in messages.

#include <cstdint>
#include <string>

namespace obscura {

/// "1 object", "2 objects", "0 objects"; `many` when it is not `one` with an s.
inline std::string count_text(std::int64_t count, const std::string& one, const std::string& many = "") {
    return std::to_string(count) + " " + (count == 1 ? one : many.empty() ? one + "s" : many);
}
inline std::string count_text(std::size_t count, const std::string& one, const std::string& many = "") {
    return count_text(static_cast<std::int64_t>(count), one, many);
}
inline std::string count_text(int count, const std::string& one, const std::string& many = "") {
    return count_text(std::int64_t{count}, one, many);
}

constexpr double mib(std::int64_t bytes) {
    return static_cast<double>(bytes) / (1 << 20);
}

}  // namespace obscura
