#pragma once
// Which files a run reads, so that no result takes the place of one.

#include <sys/types.h>

#include <filesystem>
#include <set>
#include <utility>

namespace obscura {

/// Files by where they are, not by how they are called: a symbolic or hard link and any other spelling of a
/// path are the same file.
class ReadFiles {
  public:
    /// A file that is read, or will be as soon as it is there.
    void add(const std::filesystem::path& file);
    /// Whether `file` is one of them. Nothing that cannot be inspected is.
    bool holds(const std::filesystem::path& file) const;

  private:
    std::set<std::pair<dev_t, ino_t>> nodes;
    std::set<std::filesystem::path> paths;  ///< as place_of_output() has them
};

}  // namespace obscura
