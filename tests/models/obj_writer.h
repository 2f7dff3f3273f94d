#pragma once
// OBJ files that a strict reader must accept and a careless one stumbles over.

#include <cstdint>
#include <string>

namespace obscura {

struct WrittenObj {
    std::string obj, mtl;
};

/// A file by chance: elements between faces, absolute and relative indices, corners of all four kinds,
/// polygons of 3 to 12 corners (one in a hundred of up to 300), groups or objects, materials, comments, blank
/// lines, either line end, numbers of every form. Equal seeds give equal files as long as the compiler is the
/// same.
WrittenObj write_obj(std::uint64_t seed);

}  // namespace obscura
