// The fuzzer's corpus, replayed: seeds and every input that once failed.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "app/models/file_access.h"
#include "tests/fuzz/obj_fuzz.h"

namespace obscura {
namespace {

TEST(ObjCorpus, IsReadOrRefused) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(OBSCURA_SOURCE_DIR "/tests/fuzz/corpus_obj")) {
        files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    EXPECT_GE(files.size(), 10u);
    for (const auto& file : files) {
        SCOPED_TRACE(file.filename());
        const std::string bytes = read_file(file, 1 << 20);
        try_obj({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
        // And cut off anywhere in its first kilobyte.
        for (std::size_t size = 0; size < std::min<std::size_t>(bytes.size(), 1024); ++size) {
            try_obj({reinterpret_cast<const std::uint8_t*>(bytes.data()), size});
        }
    }
}

}  // namespace
}  // namespace obscura
