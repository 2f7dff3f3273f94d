#include "tests/fuzz/tree_fuzz.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include "core/error.h"
#include "core/hash.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/codes/tree_file.h"
#include "hierarchy/codes/tree_file_format.h"

namespace obscura {
namespace {

/// Sixteen texels a side at most, corners included.
void look_up(const ShadowTree& tree) {
    const std::uint32_t last = (1u << tree.code.levels) - 1;
    const std::uint32_t step = std::max(last / 15, 1u);
    for (std::uint32_t y = 0; y <= last; y += step) {
        for (std::uint32_t x = 0; x <= last; x += step) {
            const float value = tree_value(tree.code, x, y);
            CHECK(value >= 0.0f && value <= 1.0f);
            if (tree.code.top != nullptr) CHECK(tree_value_from_top(tree.code, x, y) == value);
        }
    }
}

}  // namespace

void seal_tree_file(std::span<std::uint8_t> bytes) {
    TreeFileHeader header;
    if (bytes.size() < sizeof header) return;
    std::memcpy(&header, bytes.data(), sizeof header);
    const std::uint64_t trees =
        std::min<std::uint64_t>(header.trees, (bytes.size() - sizeof header) / sizeof(TreeRecord));
    const std::span records = bytes.subspan(sizeof header, trees * sizeof(TreeRecord));
    for (std::uint64_t i = 0; i < trees; ++i) {
        TreeRecord record;
        std::memcpy(&record, records.data() + i * sizeof record, sizeof record);
        if (record.first_byte > bytes.size() || record.bytes > bytes.size() - record.first_byte) continue;
        ShadowTree tree;
        tree.bytes = record.bytes;
        tree.code.units = bytes.data() + record.first_byte;
        tree.code.code = static_cast<ShadowCode>(record.code);
        tree.code.layout = static_cast<TreeLayout>(record.layout);
        tree.code.levels = record.levels;
        std::copy(std::begin(record.offset_scale), std::end(record.offset_scale), tree.code.offset_scale);
        record.content_hash = content_hash(tree);
        std::memcpy(records.data() + i * sizeof record, &record, sizeof record);
    }
    header.file_bytes = bytes.size();
    header.checksum = 0;
    const std::uint64_t parts[] = {bulk_hash(&header, sizeof header),
                                   bulk_hash(records.data(), records.size())};
    header.checksum = Hasher{}.value(parts).state;
    std::memcpy(bytes.data(), &header, sizeof header);
}

bool try_trees(std::span<const std::uint8_t> bytes, bool sealed) {
    // Nothing may be read behind the last byte: sanitizers see the end of this block.
    const std::shared_ptr<std::uint8_t[]> copy(new std::uint8_t[bytes.size()]);
    std::copy(bytes.begin(), bytes.end(), copy.get());
    const std::span<std::uint8_t> own(copy.get(), bytes.size());
    if (sealed) seal_tree_file(own);
    try {
        for (const ShadowTree& tree : read_tree_file(own, copy, "bytes").trees)
            look_up(tree);
        return true;
    } catch (const InputError&) {
        return false;
    }
}

}  // namespace obscura

#ifdef OBSCURA_FUZZER
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    obscura::try_trees({data, size}, true);
    return 0;
}
#endif
