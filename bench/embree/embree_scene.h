#pragma once
// A mesh as Embree traces it. Built only where Embree 3 is installed: OBSCURA_HAS_EMBREE.

#include <embree3/rtcore.h>

#include <atomic>
#include <cstdint>
#include <string>

#include "core/mesh.h"

namespace obscura {

/// Embree itself, and how much memory it holds.
class EmbreeDevice {
  public:
    /// `threads` build hierarchies; 0: as many as Embree likes. Throws std::runtime_error.
    explicit EmbreeDevice(int threads);
    ~EmbreeDevice();
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;

    RTCDevice handle() const { return device_; }
    double mib() const { return static_cast<double>(bytes_) / (1 << 20); }
    /// "Embree 3.13.5".
    std::string version() const;

  private:
    RTCDevice device_ = nullptr;
    std::atomic<std::int64_t> bytes_{0};
};

/// One triangle mesh, copied, with its hierarchy in default build quality. The device must outlive it.
class EmbreeScene {
  public:
    /// Throws std::runtime_error with Embree's error code.
    EmbreeScene(const EmbreeDevice& device, const Mesh& mesh, RTCSceneFlags flags);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCScene handle() const { return scene_; }

  private:
    RTCScene scene_ = nullptr;
};

/// For packets of rays that stay close together.
inline RTCIntersectContext coherent_context() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
}

}  // namespace obscura
