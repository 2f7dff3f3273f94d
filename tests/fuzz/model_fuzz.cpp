#include "tests/fuzz/model_fuzz.h"

#include <string_view>

#include "app/models/ply_file.h"
#include "app/models/stl_file.h"
#include "core/error.h"
#include "tests/fuzz/model_checks.h"

namespace obscura {

void try_model(std::span<const std::uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    Limits limits;
    limits.triangles = 20'000;
    for (const auto read : {ply_from_bytes, stl_from_bytes}) {
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
