#pragma once
// [shadow] cache: finished trees of scope "full" and stacks in files, one per light.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/models/file_access.h"
#include "app/scene/scene.h"
#include "hierarchy/codes/tree_file.h"
#include "hierarchy/shadow_tree.h"
#include "hierarchy/stack/stack.h"

namespace obscura {

/// The folder that a light's shadow.cache names, canonical, whether it is there or not. What counts is where
/// it leads: inside the scene's folder or an allowed one, as for every file that a scene names. Throws
/// InputError when it leads elsewhere or when something else than a folder is there.
std::filesystem::path shadow_cache_folder(const FileAccess& access, const std::string& cache);

/// The file of one light's trees, or of its stack, in the folder that its shadow.cache names. It may be a
/// link that stays where scenes may read, there or not; see check_shadow_cache(). Throws InputError as
/// shadow_cache_folder() does, and when a link of that name leads elsewhere.
std::filesystem::path shadow_cache_file(const FileAccess& access, const std::string& cache,
                                        const std::string& light, ShadowMethod method);

/// Throws OutputError when a file to keep shadows in is, by whatever name, one that the run reads otherwise.
void check_cache_not_read(const std::filesystem::path& file, const ReadFiles& read);

/// A hash of everything of a mesh that shadows depend on: positions, triangles, what casts, which components
/// are closed.
TreeFileKey geometry_key(const Mesh& mesh);

/// What a light's trees are made from: geometry, views, and the settings that reach the trees.
TreeFileKey shadow_key(const TreeFileKey& geometry, const SceneLight& light,
                       const std::vector<LightView>& views);
/// The same of its stack.
TreeFileKey shadow_key(const TreeFileKey& geometry, const SceneLight& light, const FocusedViews& views);

/// Trees of an earlier run, or none. `notice`: why a file that is there could not be used, empty otherwise.
/// A file that is broken (cut short, altered, not of this kind) or cannot be read is such a file, too.
std::vector<ShadowTree> load_shadow_cache(const std::filesystem::path& file, const TreeFileKey& key,
                                          std::string& notice);
/// The same of a stack.
std::optional<ShadowStack> load_stack_cache(const std::filesystem::path& file, const TreeFileKey& key,
                                            std::string& notice);

/// Sees that the folder can be made and `file` written in it, before anything is built for it, and leaves
/// nothing. A link is taken away: what it leads to has been of no use, and is not replaced. Throws
/// OutputError.
void check_shadow_cache(const std::filesystem::path& file);

/// Makes the folder if need be and writes the file, or leaves neither. Throws OutputError.
void save_shadow_cache(const std::filesystem::path& file, const std::vector<ShadowTree>& trees,
                       const TreeFileKey& key);
void save_shadow_cache(const std::filesystem::path& file, const ShadowStack& stack, const TreeFileKey& key);

}  // namespace obscura
