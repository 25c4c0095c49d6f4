/// \file
/// Private: the one place that knows whether Embree 3 or Embree 4 is installed. Only the two .cpp files behind which
/// Embree lives (triangle_bvh.cpp, preview.cpp) and the benchmark's reference rays include it.
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

/// What travels with a query into the callbacks. The library's own context must stay the first member: callbacks get a
/// pointer to it and cast it back.
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

/// The user pointer of the query that a callback runs for. Arguments: RTCIntersectFunctionNArguments and the like.
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

/// Sixteen rays at once; those whose entry of `valid` is -1 are shot, the others (0) are left alone. `valid` wants to
/// be aligned to 64 bytes.
inline void intersect16(const int* valid, RTCScene scene, QueryContext& context, RTCRayHit16& ray_hits) {
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context.base;
    rtcIntersect16(valid, scene, &ray_hits, &arguments);
#else
    rtcIntersect16(valid, scene, &context.base, &ray_hits);
#endif
}

/// Shoots a shadow ray; afterwards ray.tfar is -infinity when something is in the way.
inline void occluded1(RTCScene scene, QueryContext& context, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context.base;
    rtcOccluded1(scene, &ray, &arguments);
#else
    rtcOccluded1(scene, &context.base, &ray);
#endif
}

/// Asks for everything within query.radius of a point; both releases of the library agree on how.
inline void point_query1(RTCScene scene, RTCPointQuery& query, RTCPointQueryFunction function, void* user) {
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene, &query, &context, function, user);
}

/// Throws RunError when the device has recorded an error since the last call.
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

/// A new device on large pages where the system has them; other settings in Embree's own words. Geometries want mask -1
/// and rays mask -1: Embree 4 masks always.
[[nodiscard]] inline Device make_device(const std::string& settings = {}) {
    Device device(rtcNewDevice(("hugepages=1," + settings).c_str()));
    if (device.get() == nullptr) throw RunError("Embree could not create a device");
    return device;
}

}  // namespace ricochet::embree
