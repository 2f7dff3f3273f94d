#include "tests/fuzz/obj_fuzz.h"

#include <string_view>

#include "app/models/obj_file.h"
#include "core/error.h"
#include "tests/fuzz/model_checks.h"
#include "tests/fuzz/obj_peer.h"

namespace obscura {

void try_obj(std::span<const std::uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t cut = text.find('\0');
    const std::string_view mtl = cut == std::string_view::npos ? std::string_view() : text.substr(cut + 1);
    Limits limits;
    limits.triangles = 20'000;
    try {
        check_model(obj_from_text(text.substr(0, cut), mtl, limits));
        const PeerResult peer = read_by_both(text.substr(0, cut), mtl, limits);
        CHECK(peer.difference.empty(), peer.difference);
    } catch (const InputError&) {
    } catch (const LimitError&) {
    }
}

}  // namespace obscura

#ifdef OBSCURA_FUZZER
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    obscura::try_obj({data, size});
    return 0;
}
#endif
