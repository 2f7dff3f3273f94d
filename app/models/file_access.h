#pragma once
// The only way to the files a scene names: nothing outside the scene's folder and the folders the user
// allowed, nothing but regular files, nothing larger than its limit.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/models/read_files.h"
#include "core/error.h"
#include "core/limits.h"

namespace obscura {

/// Folders that may be read from. `root` is the scene file's folder, relative names start there.
struct FileAccess {
    std::filesystem::path root;
    std::vector<std::filesystem::path> allowed;  ///< further folders (--allow-path)
    bool allow_missing = false;  ///< mesh files go on without materials and textures that are not there
    std::shared_ptr<ReadFiles> read = nullptr;  ///< takes down every file that is found, if anybody asks
};

/// The InputError of a file that is not there, for callers that can do without it.
struct MissingFile : InputError {
    using InputError::InputError;
};

/// The file that `relative` means, as a canonical path. What counts is where the path leads after "..",
/// symbolic links and all: it must end inside the root or an allowed folder, so an absolute path is fine
/// there and refused elsewhere. Where nothing has that name, a \ in it stands for /. Throws InputError (file
/// = `relative`) when it leads outside or cannot be followed, MissingFile when nothing is there.
std::filesystem::path resolve_input(const FileAccess& access, std::string_view relative);

/// As above, relative to `folder`: for files that name files beside them.
std::filesystem::path resolve_beside(const FileAccess& access, const std::filesystem::path& folder,
                                     std::string_view relative);

/// The bytes of a regular file. Throws InputError with the system's reason when it cannot be opened or read
/// and for folders, FIFOs, sockets and devices (none of which it waits for); LimitError above `max_bytes`,
/// before anything is allocated.
std::string read_file(const std::filesystem::path& file, std::int64_t max_bytes);

/// The same of a file that holds a model or its materials. LimitError beyond an eighth of limits.memory_mib.
std::string read_model_bytes(const std::filesystem::path& file, const Limits& limits);

/// resolve_input() and read_file() in one; a link put in the file's place in between is not followed.
std::string read_input(const FileAccess& access, std::string_view relative, std::int64_t max_bytes);

}  // namespace obscura
