#pragma once
// Obscura's own rasterizer as a contestant.

#include "bench/harness/contestant.h"

namespace obscura {

/// Jobs: exact depth maps with all faces and without the back faces of solids; interval maps (entry and exit
/// by the full counter); frames by render_frame(). Buffers are kept from run to run, as the peers keep
/// theirs.
Contestant our_contestant();

}  // namespace obscura
