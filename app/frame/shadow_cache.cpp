#include "app/frame/shadow_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>

#include "app/scene/shadow_code.h"
#include "core/error.h"
#include "core/file_output.h"
#include "core/hash.h"
#include "hierarchy/stack/stack_file.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

/// Changes when the same inputs give other trees.
constexpr std::uint32_t construction_version = 3, stack_version = 1;

/// Two halves of a key; large arrays enter both by one hash of 64 bits.
class KeyHasher {
  public:
    template <class T>
    void add(const T& value) {
        key_.value(value);
        other_.value(value);
    }
    template <class T>
    void add_all(const std::vector<T>& values) {
        const std::uint64_t hash = bulk_hash(values.data(), values.size() * sizeof(T));
        add(hash);
        add(static_cast<std::uint64_t>(values.size()));
    }
    TreeFileKey key() const { return {other_.state, key_.state}; }

  private:
    Hasher key_, other_{0x9e3779b97f4a7c15u};
};

std::string damage_notice(const fs::path& file, const InputError& error) {
    // Nothing is lost with it: all that stands in it is made from the scene.
    return fmt::format("{} is damaged ({}); it is made again", file.string(), error.message);
}

/// Why a sound file is of no use, if it is of none.
std::string state_notice(const fs::path& file, CacheState state) {
    switch (state) {
        case CacheState::usable:
        case CacheState::absent:
            break;
        case CacheState::other_key:
            return fmt::format("{} was made from another scene, light or settings; it is made again",
                               file.string());
        case CacheState::other_version:
            return fmt::format("{} is of another version of the program; it is made again", file.string());
    }
    return "";
}

bool is_link(const fs::path& file) {
    std::error_code error;
    return fs::is_symlink(fs::symlink_status(file, error));
}

/// Of a link to nothing: where it leads all the same. Throws InputError.
void check_place(const FileAccess& access, const fs::path& link) {
    try {
        resolve_input(access, place_of_output(link).string());
    } catch (const MissingFile&) {
        // Inside what is allowed, but not there yet.
    }
}

/// A folder that is made when it is not there, and taken away again when nothing came to lie in it.
class MadeFolder {
  public:
    explicit MadeFolder(const fs::path& folder) : path(folder) {
        std::error_code error;
        made = fs::create_directory(folder, error);
        if (!error) return;
        throw OutputError(
            fmt::format("{}: cannot make the shadow cache: {}", folder.string(), error.message()));
    }
    ~MadeFolder() {
        if (made) ::rmdir(path.c_str());  // which a folder with files in it withstands
    }
    MadeFolder(const MadeFolder&) = delete;
    MadeFolder& operator=(const MadeFolder&) = delete;

  private:
    fs::path path;
    bool made = false;
};

}  // namespace

fs::path shadow_cache_folder(const FileAccess& access, const std::string& cache) {
    fs::path folder;
    try {
        folder = resolve_input(access, cache);
    } catch (const MissingFile&) {
        // Inside what is allowed, but not there yet.
        return fs::weakly_canonical((access.root.empty() ? fs::path(".") : access.root) / cache);
    }
    if (!fs::is_directory(folder)) throw InputError(cache, "the shadow cache is not a folder");
    return folder;
}

fs::path shadow_cache_file(const FileAccess& access, const std::string& cache, const std::string& light,
                           ShadowMethod method) {
    const fs::path folder = shadow_cache_folder(access, cache);
    const std::string name = light + (method == ShadowMethod::stack ? ".shadowstack" : ".shadowtree");
    FileAccess unrecorded = access;  // who keeps a list wants the name, and decides when
    unrecorded.read = nullptr;
    if (is_link(folder / name)) {
        try {
            resolve_beside(unrecorded, folder, name);
        } catch (const MissingFile&) {
            check_place(unrecorded, folder / name);
        }
    }
    return folder / name;
}

void check_cache_not_read(const fs::path& file, const ReadFiles& read) {
    if (read.holds(file))
        throw OutputError(fmt::format("{}: is read by this run and is no place for a shadow", file.string()));
}

TreeFileKey geometry_key(const Mesh& mesh) {
    KeyHasher hasher;
    hasher.add_all(mesh.positions);
    hasher.add_all(mesh.triangles);
    hasher.add_all(mesh.face);
    hasher.add_all(mesh.component);
    std::vector<std::uint8_t> closed, casts;
    for (const Component& c : mesh.components)
        closed.push_back(c.closed ? 1 : 0);
    for (const std::uint32_t object : mesh.object)
        casts.push_back(mesh.objects.empty() || mesh.objects[object].casts_shadow ? 1 : 0);
    hasher.add_all(closed);
    hasher.add_all(casts);
    return hasher.key();
}

TreeFileKey shadow_key(const TreeFileKey& geometry, const SceneLight& light,
                       const std::vector<LightView>& views) {
    KeyHasher hasher;
    hasher.add(construction_version);
    hasher.add(geometry.high);
    hasher.add(geometry.low);
    for (const LightView& view : views) {
        hasher.add(view.to_map);
        hasher.add(view.width);
        hasher.add(view.near_w);
        hasher.add(view.perspective);
    }
    hasher.add(light.shadow.receivers);
    // Keys of mh are those of before there were other codes.
    const ShadowCode code = chosen_code(light.shadow).code;
    if (code != ShadowCode::mh) hasher.add(code);
    hasher.add(light.shadow.layout);
    hasher.add(light.shadow.top_levels);
    return hasher.key();
}

TreeFileKey shadow_key(const TreeFileKey& geometry, const SceneLight& light, const FocusedViews& views) {
    KeyHasher hasher;
    hasher.add(stack_version);
    hasher.add(geometry.high);
    hasher.add(geometry.low);
    hasher.add(views.frame);
    hasher.add_all(views.slices);
    hasher.add(views.resolution);
    hasher.add(light.shadow.receivers);
    return hasher.key();
}

std::vector<ShadowTree> load_shadow_cache(const fs::path& file, const TreeFileKey& key, std::string& notice) {
    try {
        CachedTrees cached = read_cached_trees(file, key);
        notice = state_notice(file, cached.state);
        return std::move(cached.trees);
    } catch (const InputError& error) {
        notice = damage_notice(file, error);
        return {};
    }
}

std::optional<ShadowStack> load_stack_cache(const fs::path& file, const TreeFileKey& key,
                                            std::string& notice) {
    try {
        CachedStack cached = read_cached_stack(file, key);
        notice = state_notice(file, cached.state);
        return std::move(cached.stack);
    } catch (const InputError& error) {
        notice = damage_notice(file, error);
        return {};
    }
}

void check_shadow_cache(const fs::path& file) {
    const MadeFolder folder(file.parent_path());
    std::error_code unlinked;
    if (is_link(file) && !fs::remove(file, unlinked))
        throw OutputError(
            fmt::format("{}: cannot take the link away: {}", file.string(), unlinked.message()));
    // A pipe would keep whoever opens it waiting, and a device holds nothing.
    std::error_code error;
    const fs::file_type kind = fs::status(file, error).type();
    if (kind != fs::file_type::regular && kind != fs::file_type::not_found && kind != fs::file_type::none)
        throw OutputError(fmt::format("{}: is not a regular file, so no shadow cache", file.string()));
    check_writable(file, Existing::replace);
}

void save_shadow_cache(const fs::path& file, const std::vector<ShadowTree>& trees, const TreeFileKey& key) {
    const MadeFolder folder(file.parent_path());
    write_tree_file(file, trees, key);
}

void save_shadow_cache(const fs::path& file, const ShadowStack& stack, const TreeFileKey& key) {
    const MadeFolder folder(file.parent_path());
    write_stack_file(file, stack, key);
}

}  // namespace obscura
