#include "app/models/gltf_buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "app/models/text_lines.h"
#include "core/error.h"

namespace obscura {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::uint32_t magic = 0x46546c67, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;

template <class T>
T value_at(std::string_view bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/// -1: none of base64.
int sextet(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

}  // namespace

void check_held(std::int64_t bytes, const char* what, const Limits& limits, const std::string& file) {
    const std::int64_t most = limits.memory_mib * (1024 * 1024 / 8);
    if (bytes > most)
        throw LimitError(fmt::format("{}: its {} take more than {} bytes, an eighth of limits.memory_mib",
                                     file, what, most));
}

GltfParts gltf_parts(std::string_view bytes, const std::string& file) {
    if (bytes.size() < 4 || value_at<std::uint32_t>(bytes, 0) != magic) return {bytes, {}};
    const auto fail = [&](const std::string& message) { throw InputError(file, message); };
    if (bytes.size() < 12) fail("is cut within its head");
    if (const auto version = value_at<std::uint32_t>(bytes, 4); version != 2)
        fail(fmt::format("glTF {} is not read, 2 is", version));
    if (const auto length = value_at<std::uint32_t>(bytes, 8); length != bytes.size())
        fail(fmt::format("says that it has {} bytes, and has {}", length, bytes.size()));
    GltfParts parts;
    std::size_t at = 12;
    for (int chunk = 0; at < bytes.size(); ++chunk) {
        if (bytes.size() - at < 8) fail("is cut within the head of a chunk");
        const auto length = value_at<std::uint32_t>(bytes, at), type = value_at<std::uint32_t>(bytes, at + 4);
        at += 8;
        if (length > bytes.size() - at) fail(fmt::format("chunk {} is longer than the file", chunk));
        const std::string_view content = bytes.substr(at, length);
        if (chunk == 0 && type != json_chunk) fail("its first chunk is not JSON");
        if (chunk == 0) parts.json = content;
        if (chunk == 1 && type == binary_chunk) parts.binary = content;
        at += length;
    }
    return parts;
}

std::string data_of_uri(std::string_view uri, const std::string& file, const std::string& where,
                        bool& is_data) {
    is_data = uri.starts_with("data:");
    if (!is_data) return "";
    const std::size_t comma = uri.find(',');
    const auto fail = [&](const char* message) {
        throw InputError(file, fmt::format("{}: {}", where, message));
    };
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
        fail("its data URI is not base64");
    std::string_view text = uri.substr(comma + 1);
    while (text.ends_with('='))
        text.remove_suffix(1);
    std::string out;
    out.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int six = sextet(c);
        if (six < 0) fail("its data URI is not base64");
        bits = bits << 6 | static_cast<std::uint32_t>(six);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        out += static_cast<char>(bits >> count & 0xffu);
    }
    if (text.size() % 4 == 1) fail("its data URI is cut");
    return out;
}

std::string percent_decoded(std::string_view uri) {
    std::string out;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1,
                  low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : -1;
        if (uri[i] == '%' && high >= 0 && low >= 0) {
            out += static_cast<char>(16 * high + low);
            i += 2;
        } else {
            out += uri[i];
        }
    }
    return out;
}

GltfBuffers::GltfBuffers(const GltfDocument& document, const GltfParts& parts, const std::string& file,
                         const Limits& limits, const std::function<std::string(const std::string&)>& read)
    : document_(document), buffers_(document.buffers.size()) {
    std::int64_t held_bytes = 0;
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
        const GltfBuffer& b = document.buffers[i];
        const std::string where = fmt::format("buffers[{}]", i);
        if (b.uri.empty()) {
            if (i != 0) throw InputError(file, where + ": only the first may be the file's own");
            buffers_[i] = parts.binary;
        } else {
            const auto [at, is_new] = held_.try_emplace(b.uri);
            if (is_new) {
                bool is_data = false;
                at->second = data_of_uri(b.uri, file, where, is_data);
                if (!is_data) at->second = read(percent_decoded(b.uri));
                held_bytes += static_cast<std::int64_t>(at->second.size());
                check_held(held_bytes, "buffers", limits, file);
            }
            buffers_[i] = at->second;
        }
        if (static_cast<std::int64_t>(buffers_[i].size()) < b.bytes) {
            throw InputError(file, fmt::format("{}: has {} bytes, not the {} that it says", where,
                                               buffers_[i].size(), b.bytes));
        }
    }
}

std::string_view GltfBuffers::view(GltfIndex view) const {
    const GltfView& v = document_.views[static_cast<std::size_t>(view)];
    return buffers_[static_cast<std::size_t>(v.buffer)].substr(static_cast<std::size_t>(v.offset),
                                                               static_cast<std::size_t>(v.bytes));
}

double GltfBuffers::number(const GltfAccessor& a, std::int64_t element, int component) const {
    if (a.view < 0) return 0;
    const int size = gltf_size(a.component);
    const std::int64_t stride = document_.views[static_cast<std::size_t>(a.view)].stride;
    const auto at = static_cast<std::size_t>(
        a.offset + element * (stride != 0 ? stride : std::int64_t{size} * a.width) + component * size);
    const std::string_view bytes = view(a.view);
    double value = 0, most = 1;
    switch (a.component) {
        case GltfComponent::int8:
            value = value_at<std::int8_t>(bytes, at), most = 127;
            break;
        case GltfComponent::uint8:
            value = value_at<std::uint8_t>(bytes, at), most = 255;
            break;
        case GltfComponent::int16:
            value = value_at<std::int16_t>(bytes, at), most = 32767;
            break;
        case GltfComponent::uint16:
            value = value_at<std::uint16_t>(bytes, at), most = 65535;
            break;
        case GltfComponent::uint32:
            value = value_at<std::uint32_t>(bytes, at), most = 4294967295.0;
            break;
        case GltfComponent::float32:
            return static_cast<double>(value_at<float>(bytes, at));
    }
    return a.normalized ? std::max(value / most, -1.0) : value;
}

}  // namespace obscura
