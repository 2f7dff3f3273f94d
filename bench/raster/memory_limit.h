#pragma once
// What the machine itself allows: writing a result of the workload's size, without computing anything.

#include "bench/harness/contestant.h"

namespace obscura {

/// Jobs: streaming stores over the floats of a depth map and of a dual-depth map. No renderer of dense maps
/// in ordinary memory can be faster.
Contestant memory_limit_contestant();

}  // namespace obscura
