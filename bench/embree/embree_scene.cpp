#include "bench/embree/embree_scene.h"

#include <fmt/format.h>

#include <cstring>
#include <stdexcept>

namespace obscura {
namespace {

bool count_bytes(void* total, ssize_t bytes, bool) {
    *static_cast<std::atomic<std::int64_t>*>(total) += bytes;
    return true;
}

template <class T>
void upload(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const std::vector<T>& values) {
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), values.size());
    std::memcpy(buffer, values.data(), values.size() * sizeof(T));
}

}  // namespace

EmbreeDevice::EmbreeDevice(int threads)
    : device_(rtcNewDevice(threads > 0 ? fmt::format("threads={}", threads).c_str() : nullptr)) {
    if (device_ == nullptr) throw std::runtime_error("Embree cannot create a device");
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
}

EmbreeDevice::~EmbreeDevice() {
    rtcReleaseDevice(device_);
}

std::string EmbreeDevice::version() const {
    const auto property = [&](RTCDeviceProperty p) { return rtcGetDeviceProperty(device_, p); };
    return fmt::format("Embree {}.{}.{}", property(RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                       property(RTC_DEVICE_PROPERTY_VERSION_MINOR),
                       property(RTC_DEVICE_PROPERTY_VERSION_PATCH));
}

EmbreeScene::EmbreeScene(const EmbreeDevice& device, const Mesh& mesh, RTCSceneFlags flags)
    : scene_(rtcNewScene(device.handle())) {
    RTCGeometry geometry = rtcNewGeometry(device.handle(), RTC_GEOMETRY_TYPE_TRIANGLE);
    upload(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.positions);
    upload(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
    rtcCommitGeometry(geometry);
    rtcSetSceneFlags(scene_, flags);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    if (const RTCError error = rtcGetDeviceError(device.handle()); error != RTC_ERROR_NONE) {
        rtcReleaseScene(scene_);
        throw std::runtime_error(fmt::format("Embree error {}", static_cast<int>(error)));
    }
}

EmbreeScene::~EmbreeScene() {
    rtcReleaseScene(scene_);
}

}  // namespace obscura
