/// \file
/// Wrapper that hides the difference between Embree 3 and 4. Private: only .cpp files that use Embree include it.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <string>
#include <utility>

#include "ricochet/core/error.h"

namespace ricochet::embree {

/// Context of a query, passed to the callbacks. Embree's own context must stay the first member, because callbacks
/// receive a pointer to it and cast it back.
struct QueryContext {
#if RTC_VERSION_MAJOR >= 4
    RTCRayQueryContext base;
#else
    RTCIntersectContext base;
#endif
    void* user = nullptr;
};

inline void init_context(QueryContext& context, void* user) {
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&context.base);
#else
    rtcInitIntersectContext(&context.base);
#endif
    context.user = user;
}

/// Returns the user pointer of the query from which Embree called a callback. Arguments: RTCIntersectFunctionNArguments
/// and similar types.
template <class Arguments>
[[nodiscard]] inline void* user_of(const Arguments* arguments) {
    return reinterpret_cast<const QueryContext*>(arguments->context)->user;
}

inline void intersect1(RTCScene scene, QueryContext& context, RTCRayHit& ray_hit) {
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context.base;
    rtcIntersect1(scene, &ray_hit, &arguments);
#else
    rtcIntersect1(scene, &context.base, &ray_hit);
#endif
}

/// Throws RunError if the device has recorded an error since the last call. A null device reports errors of devices
/// that could not be created.
inline void check_device(RTCDevice device, const char* doing) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    throw RunError(std::string("Embree failed while ") + doing + " (error code " +
                   std::to_string(static_cast<int>(error)) + "): free memory may be short");
}

/// Owns an Embree handle; the release function is part of the type.
template <class Handle, void (*Release)(Handle)>
class Owned {
public:
    Owned() = default;
    explicit Owned(Handle handle) : handle_(handle) {}
    Owned(Owned&& other) noexcept : handle_(other.handle_) { other.handle_ = nullptr; }
    Owned& operator=(Owned&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    Owned(const Owned&) = delete;
    Owned& operator=(const Owned&) = delete;
    ~Owned() {
        if (handle_ != nullptr) Release(handle_);
    }
    [[nodiscard]] Handle get() const { return handle_; }

private:
    Handle handle_ = nullptr;
};

using Device = Owned<RTCDevice, rtcReleaseDevice>;
using Scene = Owned<RTCScene, rtcReleaseScene>;

/// Makes a new device. config: a configuration string of Embree. Geometries and rays need mask -1, because Embree 4
/// always applies masks.
[[nodiscard]] inline Device make_device(const std::string& config = {}) {
    Device device(rtcNewDevice(config.c_str()));
    if (device.get() != nullptr) return device;
    check_device(nullptr, "creating a device");
    throw RunError("Embree could not create a device");
}

}  // namespace ricochet::embree
