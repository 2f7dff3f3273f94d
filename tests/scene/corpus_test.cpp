// The fuzzer's corpus, replayed: seeds, and every text that once broke the reader.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "app/models/file_access.h"
#include "tests/fuzz/scene_fuzz.h"

namespace obscura {
namespace {

TEST(SceneCorpus, IsReadOrRefused) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(OBSCURA_SOURCE_DIR "/tests/fuzz/corpus_scene")) {
        files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    EXPECT_GE(files.size(), 20u);
    for (const auto& file : files) {
        SCOPED_TRACE(file.filename());
        const std::string text = read_file(file, 1 << 20);
        const std::string problem = try_scene(text);
        EXPECT_EQ(problem.empty(), file.filename().string().starts_with("good_")) << problem;
        // And cut off anywhere in its first kilobyte.
        for (std::size_t size = 0; size < std::min<std::size_t>(text.size(), 1024); ++size) {
            try_scene(std::string_view(text).substr(0, size));
        }
    }
}

}  // namespace
}  // namespace obscura
