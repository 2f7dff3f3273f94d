#pragma once
// What takes part in a bench: a contestant opens a scene in a process of its own and offers jobs to be timed.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/harness/stage.h"
#include "core/isa.h"

namespace obscura {

/// What is asked for. A result is a plain array of floats:
///  - depth: nearest depth per texel of the light view, 1 = nothing there;
///  - dual_depth: two such maps one after the other, the second 1 where there is no second surface;
///  - frame: linear RGB triples, exactly 0 where nothing is seen. The light has moved since the last frame:
///    shadow maps are new, a hierarchy over the scene is kept;
///  - static_frame: the same when only the camera has moved: shadow maps are kept too.
/// The shadow bench asks for two more, without results to compare there:
///  - shadow_map: makes a light's shadow map;
///  - lookup: visibility of every pixel of a picture.
enum class Workload { depth, dual_depth, frame, static_frame, shadow_map, lookup };
/// One thing a contestant can do with an opened scene.
struct Job {
    Workload workload = Workload::depth;
    std::string method;
    bool same_work = true;      ///< false: less than the workload asks, or another result; such a
                                ///< job is charted but never counts as the peer to beat
    std::function<void()> run;  ///< timed: everything from clearing to the finished result
    std::function<void(float* result)> deliver;  ///< not timed: copies the last result out, see Workload;
                                                 ///< empty: the job has no result that could be compared
};

/// A scene made ready by a contestant. `state` owns whatever the jobs refer to.
struct Session {
    std::string version;     ///< library, version and what it says about itself
    double prepare_ms = 0;   ///< building the BVH or uploading the mesh: reported, not part of a job's time
    double prepare_mib = 0;  ///< memory that took, 0 when not known
    std::vector<Job> jobs;
    std::shared_ptr<void> state;
};

/// `open` runs in a fresh process that is pinned to exec.threads cores. When `absent` says why the contestant
/// cannot take part, `open` is empty.
struct Contestant {
    std::string name;
    std::string absent;
    std::function<Session(const BenchScene& scene, const Exec& exec)> open;
};

}  // namespace obscura
