#pragma once
// The bytes of a glTF file: its two parts, its buffers, and numbers in them.

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/models/gltf_document.h"
#include "core/limits.h"

namespace obscura {

/// A .glb file has both, a .gltf the text alone.
struct GltfParts {
    std::string_view json, binary;
};

/// Throws LimitError when `bytes` is more than an eighth of limits.memory_mib.
void check_held(std::int64_t bytes, const char* what, const Limits& limits, const std::string& file);

/// Throws InputError for a .glb that is cut, or has other chunks than it should.
GltfParts gltf_parts(std::string_view bytes, const std::string& file);

/// The data of a URI "data:...;base64,...", or "" with `is_data` false. Throws InputError, at `where`.
std::string data_of_uri(std::string_view uri, const std::string& file, const std::string& where,
                        bool& is_data);

/// %20 and the like as bytes.
std::string percent_decoded(std::string_view uri);

class GltfBuffers {
  public:
    /// `read(uri)`: a file that a buffer names. Throws InputError for buffers that are shorter than they say,
    /// LimitError when all together take more than an eighth of limits.memory_mib.
    GltfBuffers(const GltfDocument& document, const GltfParts& parts, const std::string& file,
                const Limits& limits, const std::function<std::string(const std::string&)>& read);

    std::string_view view(GltfIndex view) const;

    /// A component of an element, normalized where the accessor says so; `element` below the accessor's
    /// count.
    double number(const GltfAccessor& accessor, std::int64_t element, int component) const;

  private:
    const GltfDocument& document_;
    std::map<std::string, std::string> held_;  ///< by URI
    std::vector<std::string_view> buffers_;
};

}  // namespace obscura
