// The fuzzer's corpus, replayed: seeds and every input that once failed.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "app/models/file_access.h"
#include "tests/fuzz/model_fuzz.h"

namespace obscura {
namespace {

TEST(ModelCorpus, IsReadOrRefused) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(OBSCURA_SOURCE_DIR "/tests/fuzz/corpus_model")) {
        files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    EXPECT_GE(files.size(), 6u);
    for (const auto& file : files) {
        SCOPED_TRACE(file.filename());
        const std::string bytes = read_file(file, 1 << 20);
        for (std::size_t size = 0; size <= bytes.size(); ++size)
            try_model({reinterpret_cast<const std::uint8_t*>(bytes.data()), size});
    }
}

}  // namespace
}  // namespace obscura
