/// \file
/// Private to the references: conversion of a ray to Embree's format. Only .cpp files that trace rays include this
/// file.
#pragma once

#include <array>

#include "lab/bench/native_rays.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/acceleration/embree.h"

namespace ricochet::bench {

/// Distance from a surface at which a ray starts after a bounce, relative to the largest coordinate of the mesh. The
/// distance is about ten rounding units of a float, as in renderers. With a smaller distance, rays hit the triangle
/// that they leave. With a larger distance, rays can start behind a nearby wall.
inline constexpr double kRayOffset = 1e-6;

[[nodiscard]] inline RTCRayHit ray_of(const RaySegment& segment) {
    RTCRayHit ray{};
    ray.ray.org_x = segment.from[0];
    ray.ray.org_y = segment.from[1];
    ray.ray.org_z = segment.from[2];
    ray.ray.dir_x = segment.along[0];
    ray.ray.dir_y = segment.along[1];
    ray.ray.dir_z = segment.along[2];
    ray.ray.tnear = 0.0F;
    ray.ray.tfar = 1.0F;
    ray.ray.mask = 0xFFFFFFFFU;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.primID = kNoTriangle;
    return ray;
}

[[nodiscard]] inline std::array<float, 3> to_floats(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace ricochet::bench
