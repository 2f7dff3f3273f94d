#pragma once
// Files of small trees, as they are written and as nobody should have written them.

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/error.h"
#include "hierarchy/codes/tree_file.h"
#include "hierarchy/codes/tree_file_format.h"
#include "tests/core/temporary_folder.h"
#include "tests/fuzz/tree_fuzz.h"
#include "tests/hierarchy/code_cases.h"
#include "tests/hierarchy/tree_samples.h"

namespace obscura {

inline constexpr TreeFileKey key{0x0123456789abcdefu, 42};

inline ShadowTree small_tree(TreeLayout layout = TreeLayout::words24, int top = 1) {
    return encode_tree(build_bottom_up(random_interval_map(4, 8).view()), any_view(3), {layout, top});
}

/// In any code; of sixteen texels a side, so that there is something to merge.
inline ShadowTree small_tree(const CodeCase& c, int top = 1) {
    return encode_tree(build_bottom_up(random_interval_map(4, 16).view()), any_view(4), params_of(c, top));
}
inline constexpr CodeCase merged_case = code_cases[3], merged_bits_case = code_cases[4],
                          dag_case = code_cases[5], dag_bits_case = code_cases[6],
                          dag_low_case = code_cases[7], packed_case = code_cases[11],
                          packed_bits_case = code_cases[12], packed_low_case = code_cases[13];

inline std::vector<std::uint8_t> bytes_of(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline std::vector<std::uint8_t> file_of(const std::vector<ShadowTree>& trees) {
    const TemporaryFolder folder;
    write_tree_file(folder.path / "trees", trees, key);
    return bytes_of(folder.path / "trees");
}

/// Applies `change` to the record and the words of the only tree, seals the file and reads it.
template <class Change>
std::string crafted(const ShadowTree& tree, const Change& change) {
    std::vector<std::uint8_t> bytes = file_of({tree});
    TreeRecord record;
    std::memcpy(&record, bytes.data() + sizeof(TreeFileHeader), sizeof record);
    change(record, bytes.data() + record.first_byte);
    std::memcpy(bytes.data() + sizeof(TreeFileHeader), &record, sizeof record);
    seal_tree_file(bytes);
    try {
        read_tree_file(bytes, nullptr, "crafted");
    } catch (const InputError& error) {
        return error.message;
    }
    return "accepted";
}

inline std::uint32_t word_at(const std::uint8_t* units, std::size_t i) {
    std::uint32_t word;
    std::memcpy(&word, units + 4 * i, 4);
    return word;
}

inline void set_word(std::uint8_t* units, std::size_t i, std::uint32_t word) {
    std::memcpy(units + 4 * i, &word, 4);
}

}  // namespace obscura
