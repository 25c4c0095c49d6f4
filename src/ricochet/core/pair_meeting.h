/// \file
/// Record, for the verifier, of an impact between spheres.
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
    double mass = 1.0;           ///< in kg
    double radius = 0.0;         ///< in m
    bool is_fixed = false;       ///< it is immovable
    RecordedMotion before;
    RecordedMotion after;
    std::uint32_t material = 0;  ///< number of the material
    double contact_path = 0.0;   ///< length of approximate sliding and rolling arcs on walls in this step, in m
};

/// Contact of two of the spheres.
struct MetContact {
    std::size_t first = 0;   ///< index among the spheres
    std::size_t second = 0;  ///< index among the spheres
    Vec3 impulse;            ///< in N s, from the first to the second
};

/// Spheres whose impacts were solved as one problem, at one time.
struct PairMeeting {
    double time = 0.0;  ///< in s
    std::vector<MetSphere> spheres;
    std::vector<MetContact> contacts;
};

}  // namespace ricochet
