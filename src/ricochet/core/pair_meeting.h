/// \file
/// An impact of spheres on each other, as it is recorded for the verifier.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/core/motion_part.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// A solid sphere, I = 2/5 m r^2, just before and just after an impact.
struct MetSphere {
    std::uint64_t particle = 0;  ///< id
    double mass = 1.0;           ///< kg
    double radius = 0.0;         ///< m
    bool is_fixed = false;       ///< nothing moves it
    RecordedMotion before;
    RecordedMotion after;
    std::uint32_t material = 0;  ///< its number
    double bound_way = 0.0;      ///< m, that it has slid or rolled on walls in this step, in approximate arcs
};

/// Two of the spheres touch.
struct MetContact {
    std::size_t first = 0;   ///< its number among the spheres
    std::size_t second = 0;  ///< the same
    Vec3 impulse;            ///< N s, that the first has given to the second
};

/// Spheres that were answered as one problem, at one time.
struct PairMeeting {
    double time = 0.0;  ///< s
    std::vector<MetSphere> spheres;
    std::vector<MetContact> contacts;
};

}  // namespace ricochet
