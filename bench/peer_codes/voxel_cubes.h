#pragma once
// The different cubes of a voxel DAG, each stored once.

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace obscura {

/// A cube by what is in it: light, shadow, or nothing that anyone asks for; else its number, from first_mixed
/// on. Cubes of 2 voxels a side have a bit per voxel for a number, lit where it is set, x + 2 y + 4 z.
enum class CubeId : std::uint32_t { shadow = 0, lit = 1, free = 2, first_mixed = 3 };

constexpr bool is_mixed(CubeId id) {
    return id >= CubeId::first_mixed;
}
constexpr std::uint32_t number_of(CubeId id) {
    return static_cast<std::uint32_t>(id) - static_cast<std::uint32_t>(CubeId::first_mixed);
}
constexpr CubeId mixed_cube(std::uint32_t number) {
    return static_cast<CubeId>(number + static_cast<std::uint32_t>(CubeId::first_mixed));
}

/// The eight octants of a cube, x + 2 y + 4 z; z grows away from the light.
using Octants = std::array<CubeId, 8>;

/// Levels of cubes that are one word of 64 bits.
constexpr int leaf_level = 2;

class CubeTable {
  public:
    explicit CubeTable(int levels);

    /// The cube of 2^level voxels a side with these octants, of the level below. What is free becomes light
    /// or shadow where that makes all one, and shadow in mixed cubes.
    CubeId cube(int level, const Octants& octants);

    /// A voxel of a cube of 2^level a side.
    bool lit(int level, CubeId cube, std::uint32_t x, std::uint32_t y, std::uint32_t z) const;

    /// Different mixed cubes of 2^level voxels a side, from leaf_level on.
    std::size_t count(int level) const;
    /// Those that some cube below `root`, of the topmost level, points to; the others have become part of
    /// nothing.
    std::vector<std::size_t> reached(CubeId root) const;
    /// Of those: leaves 8; others a word with two bits an octant, and a word for each mixed one.
    std::uint64_t bytes(CubeId root) const;

  private:
    struct HashOctants {
        std::size_t operator()(const Octants& octants) const;
    };
    struct Level {
        std::vector<Octants> cubes;
        std::unordered_map<Octants, std::uint32_t, HashOctants> numbers;
    };
    std::vector<std::vector<bool>> marks(CubeId root) const;

    std::vector<Level> levels_;          ///< from leaf_level + 1 on
    std::vector<std::uint64_t> leaves_;  ///< a bit per voxel, an octant of 8 after the other
    std::unordered_map<std::uint64_t, std::uint32_t> leaf_numbers_;
};

}  // namespace obscura
