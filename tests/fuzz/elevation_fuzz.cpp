#include "tests/fuzz/elevation_fuzz.h"

#include <cmath>
#include <string>
#include <string_view>

#include "app/elevation/elevation.h"
#include "core/error.h"

namespace obscura {

void try_elevation(std::span<const std::uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    ElevationOptions options;
    options.max_bytes = 4 << 20;
    options.holes = HolePolicy::fill;
    for (const char* name : {"a.tif", "a.asc", "a.pgm", "a.png", "N37E014.hgt"}) {
        try {
            const ElevationModel model = decode_elevation(text, name, {}, options);
            check_height_field(model.field);
            CHECK(model.least_m <= model.greatest_m && std::fabs(model.least_m) <= largest_height_m &&
                  std::fabs(model.greatest_m) <= largest_height_m);
        } catch (const InputError&) {
        } catch (const LimitError&) {
        }
    }
}

}  // namespace obscura

#ifdef OBSCURA_FUZZER
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    obscura::try_elevation({data, size});
    return 0;
}
#endif
