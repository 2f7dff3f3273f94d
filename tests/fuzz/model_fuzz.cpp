#include "tests/fuzz/model_fuzz.h"

#include <string_view>

#include "app/models/gltf_file.h"
#include "app/models/ply_file.h"
#include "app/models/stl_file.h"
#include "core/error.h"
#include "tests/fuzz/model_checks.h"

namespace obscura {

void try_model(std::span<const std::uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    Limits limits;
    limits.triangles = 20'000;
    const auto gltf_alone = [](std::string_view from, const std::string& file, const Limits& most,
                               const ModelOptions& options) {
        return gltf_from_bytes(from, file, most, options, [](const std::string& uri) -> std::string {
            throw InputError(uri, "there is no other file");
        });
    };
    using Read = Model (*)(std::string_view, const std::string&, const Limits&, const ModelOptions&);
    for (const Read read : {Read{ply_from_bytes}, Read{stl_from_bytes}, Read{gltf_alone}}) {
        try {
            check_model(read(text, "bytes", limits, {}));
        } catch (const InputError&) {
        } catch (const LimitError&) {
        }
    }
}

}  // namespace obscura

#ifdef OBSCURA_FUZZER
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    obscura::try_model({data, size});
    return 0;
}
#endif
