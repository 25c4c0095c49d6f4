/// \file
/// Motion of a particle during a part of a step, recorded for the verifier.
#pragma once

#include <array>
#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Motion at one time.
struct RecordedMotion {
    Vec3 position;  ///< of the centre, in m
    Vec3 velocity;  ///< in m/s
    Vec3 spin;      ///< in rad/s

    friend bool operator==(const RecordedMotion&, const RecordedMotion&) = default;
};

/// Part of a step. The parts of a step are contiguous: each begins with the motion at the end of the part before.
struct MotionPart {
    enum class Kind : std::uint8_t {
        flight,   ///< free flight: the motion follows the integrator
        impact,   ///< an instantaneous change by surfaces, such as an impact
        contact,  ///< an interval of contact with surfaces
        driven,   ///< an impact on, or contact with, surfaces that may add energy because they move or are hot
    };

    Kind kind = Kind::flight;
    double time = 0.0;      ///< in s, simulation time at the start
    double duration = 0.0;  ///< in s
    double radius = 0.0;    ///< in m, of the solid sphere that touches surfaces; 0 for points
    RecordedMotion begin;
    RecordedMotion end;
    /// Force over the mass, in m/s^2, at the start, in the middle and at the end of a contact. Springs oscillate within
    /// a step, so the force in the middle can be outside the range of the values at both ends.
    std::array<Vec3, 3> forces{};
    bool forces_are_steady = true;  ///< the forces do not depend on time, position or velocity
};

}  // namespace ricochet
