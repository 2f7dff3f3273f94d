#pragma once
// Values of a JSON text, each knowing where it stands. For gltf_document.cpp alone: it brings nlohmann's
// header.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"

namespace obscura {

using Json = nlohmann::json;

/// A value and where it stands.
class JsonPlace {
  public:
    JsonPlace(const Json& value, std::string where, const std::string& file)
        : value_(value), where_(std::move(where)), file_(file) {}

    [[noreturn]] void fail(const std::string& message) const {
        throw InputError(file_, where_.empty() ? message : fmt::format("{}: {}", where_, message));
    }

    bool has(const char* key) const { return value_.is_object() && value_.contains(key); }
    JsonPlace at(const char* key) const {
        if (!has(key)) fail(fmt::format("'{}' is missing", key));
        return {value_[key], where_.empty() ? key : fmt::format("{}.{}", where_, key), file_};
    }
    /// The elements of a list under a key; none where there is no such key.
    std::vector<JsonPlace> list(const char* key) const {
        std::vector<JsonPlace> all;
        if (!has(key)) return all;
        const JsonPlace list = at(key);
        if (!list.value_.is_array()) list.fail("is not a list");
        for (std::size_t i = 0; i < list.value_.size(); ++i)
            all.emplace_back(list.value_[i], fmt::format("{}[{}]", list.where_, i), file_);
        return all;
    }
    std::vector<std::string> keys() const {
        std::vector<std::string> all;
        if (!value_.is_object()) return all;
        for (const auto& item : value_.items())
            all.push_back(item.key());
        return all;
    }

    double number() const {
        if (!value_.is_number()) fail("is not a number");
        const auto v = value_.get<double>();
        if (!(std::fabs(v) <= static_cast<double>(std::numeric_limits<float>::max())))
            fail("is not a number within the range of floats");
        return v;
    }
    double number(const char* key, double otherwise, double low, double high) const {
        if (!has(key)) return otherwise;
        const double v = at(key).number();
        if (!(v >= low && v <= high)) at(key).fail(fmt::format("{} is not within {} to {}", v, low, high));
        return v;
    }
    std::int64_t integer(const char* key, std::int64_t otherwise) const {
        if (!has(key)) return otherwise;
        const JsonPlace p = at(key);
        constexpr std::int64_t most = std::int64_t{1} << 53;
        if (!p.value_.is_number()) p.fail("is not a number");
        const auto v = p.value_.get<double>();
        if (!(v >= 0 && v <= static_cast<double>(most) && v == std::floor(v)))
            p.fail("is not a whole number from 0 on");
        return static_cast<std::int64_t>(v);
    }
    std::int32_t index(const char* key, std::size_t size) const {
        if (!has(key)) return -1;
        const std::int64_t i = integer(key, 0);
        if (i >= static_cast<std::int64_t>(size)) at(key).fail(fmt::format("there is no {} of {}", i, size));
        return static_cast<std::int32_t>(i);
    }
    std::string text(const char* key) const {
        if (!has(key)) return "";
        const JsonPlace p = at(key);
        if (!p.value_.is_string()) p.fail("is not a text");
        return p.value_.get<std::string>();
    }
    template <std::size_t n>
    std::array<double, n> numbers(const char* key, const std::array<double, n>& otherwise) const {
        if (!has(key)) return otherwise;
        const std::vector<JsonPlace> all = list(key);
        if (all.size() != n) at(key).fail(fmt::format("has {} numbers, not {}", all.size(), n));
        std::array<double, n> out;
        for (std::size_t i = 0; i < n; ++i)
            out[i] = all[i].number();
        return out;
    }
    bool flag(const char* key) const {
        if (!has(key)) return false;
        if (!at(key).value_.is_boolean()) at(key).fail("is neither true nor false");
        return at(key).value_.get<bool>();
    }
    std::size_t size(const char* key) const {
        return has(key) && value_[key].is_array() ? value_[key].size() : 0;
    }
    const Json& value() const { return value_; }

  private:
    const Json& value_;
    std::string where_;
    const std::string& file_;
};

}  // namespace obscura
