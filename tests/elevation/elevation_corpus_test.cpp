// The fuzzer's corpus of elevation models, replayed: seeds and every input that once failed, whole and cut
// short.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/elevation_fuzz.h"

namespace obscura {
namespace {

TEST(ElevationCorpus, IsReadOrRefused) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(OBSCURA_SOURCE_DIR "/tests/fuzz/corpus_elevation"))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    EXPECT_GE(files.size(), 6u);
    for (const auto& file : files) {
        SCOPED_TRACE(file.filename());
        std::ifstream in(file, std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(in), {}};
        for (std::size_t size = 0; size <= bytes.size(); ++size)
            try_elevation({reinterpret_cast<const std::uint8_t*>(bytes.data()), size});
    }
}

}  // namespace
}  // namespace obscura
