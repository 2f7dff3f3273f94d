#pragma once
// The text of an MTL file as materials. Nothing here is looked up or opened yet.

#include <string>
#include <string_view>
#include <vector>

#include "core/scene.h"

namespace obscura {

/// What one newmtl block says.
struct MtlEntry {
    std::string name;      ///< the whole rest of the newmtl line
    Material material;     ///< without its texture
    std::string texture;   ///< map_Kd: the file as written, the whole rest of the line; empty = none
    std::string file;      ///< that the block stands in
    int texture_line = 0;  ///< of map_Kd, for messages
    std::vector<std::string> unread;  ///< keywords that would be seen and are not obeyed, each once
    /// Of what is obeyed, what the Material does without, as phrases, each once.
    std::vector<std::string> changed;
    bool transparent = false;  ///< by d, Tr, Tf, map_d or illum; drawn opaque all the same
};

/// Reads Kd, Ks, Ke, Ns, Pr, Pm and map_Kd of every newmtl block (see load_obj() for what they become); notes
/// what else would be seen. Ka and what shades nothing by itself (illum of opaque kinds, Ni, sharpness) are
/// passed over. `file` names the text in messages. Throws InputError with the line.
std::vector<MtlEntry> parse_mtl_text(std::string_view text, const std::string& file);

}  // namespace obscura
