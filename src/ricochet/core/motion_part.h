/// \file
/// What a particle did in a part of a step, as it is recorded for the verifier.
#pragma once

#include <array>
#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// A motion at one time.
struct RecordedMotion {
    Vec3 position;  ///< of the centre, m
    Vec3 velocity;  ///< m/s
    Vec3 spin;      ///< rad/s

    friend bool operator==(const RecordedMotion&, const RecordedMotion&) = default;
};

/// A part of a step. The parts of a step follow each other: each begins with the motion that the one before has ended
/// with.
struct MotionPart {
    enum class Kind : std::uint8_t {
        flight,   ///< nothing touches it: its motion is the integrator's
        impact,   ///< at one time, or what else surfaces change at one time
        contact,  ///< an interval in which surfaces hold it
        driven,   ///< an impact on or contact with surfaces that may give it energy: they move or are hot
    };

    Kind kind = Kind::flight;
    double time = 0.0;      ///< s, simulation time at its begin
    double duration = 0.0;  ///< s
    double radius = 0.0;    ///< m, of the solid sphere that touches surfaces; 0 for points
    RecordedMotion begin;
    RecordedMotion end;
    /// Over the mass, m/s^2, at the begin, in the middle and at the end of contact: springs swing within a step, and
    /// what they do in between may lie beyond what they do at both ends.
    std::array<Vec3, 3> forces{};
    bool forces_are_steady = true;  ///< they are the same all the time, wherever it is and however it moves
};

}  // namespace ricochet
