#pragma once
// Output files that are either complete or not there.

#include <filesystem>
#include <span>
#include <string_view>

namespace obscura {

/// What to do when the target exists.
enum class Existing { refuse, replace };

/// Writes `bytes` to `path`: into a temporary ".part.PID-N" beside it, every write checked, synced,
/// renamed over the target, whose mode it takes, directory synced. On any failure the temporary is removed,
/// the old target is untouched, and OutputError names the file and the reason. A target that is not a regular
/// file (/dev/stdout, a pipe) is written directly; a symbolic link is followed.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes,
                           Existing existing = Existing::refuse);

/// The same for contents in several parts, one behind the other: large ones need not be joined in memory.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::string_view> parts,
                           Existing existing = Existing::refuse);

/// Throws the OutputError that write_file_atomically() would meet for reasons already visible: the directory
/// is missing, not a directory or not writable (tried by creating a file there), the target is a directory,
/// or it exists and may not be replaced. Call it before hours of rendering.
void check_writable(const std::filesystem::path& path, Existing existing = Existing::refuse);

/// The file that writing to `path` makes or replaces: absolute, links followed, also those that lead to
/// nothing yet. Two paths with one place are one file.
std::filesystem::path place_of_output(const std::filesystem::path& path);

/// Removes the temporaries of writes under way. For signal handlers: async-signal-safe, never blocks.
void remove_pending_outputs() noexcept;

}  // namespace obscura
