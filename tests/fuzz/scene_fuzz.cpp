#include "tests/fuzz/scene_fuzz.h"

#include "app/scene/scene_file.h"
#include "core/error.h"

namespace obscura {

std::string try_scene(std::string_view text) {
    SceneDocument document;
    try {
        document = read_scene_text(text, "fuzz.toml");
    } catch (const InputError& error) {
        return error.what();
    } catch (const LimitError& error) {
        return error.what();
    }
    const std::string dump = dump_scene(document);
    CHECK(dump_scene(read_scene_text(dump, "dump.toml")) == dump, dump);
    return "";
}

}  // namespace obscura

#ifdef OBSCURA_FUZZER
#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    obscura::try_scene({reinterpret_cast<const char*>(data), size});
    return 0;
}
#endif
