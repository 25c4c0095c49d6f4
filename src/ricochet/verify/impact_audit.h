/// \file
/// Audit of a recorded impact between spheres. An impact passes under these conditions:
/// - The spheres touched.
/// - The impulses are repulsive and inside the friction cone.
/// - The motion of each sphere changed only by its impulses.
/// - Momentum and angular momentum are conserved.
/// - No energy was gained. If there is no dissipation, no energy was lost.
#pragma once

#include <cstddef>
#include <vector>

#include "ricochet/core/pair_meeting.h"

namespace ricochet::verify {

/// Tolerances of the audit, relative to the sum of the magnitudes of all terms. kPairBooks applies to momentum and
/// energy, kPairAngularBooks to angular momentum. They allow for rounding of the impulses. If many spheres touch at
/// once, they also allow for the finite number of solver iterations over the contacts. With smaller values, rounding
/// would be reported. With larger values, wrong impulses would not be found. Local: tolerances of the audit, which do
/// not affect the run.
inline constexpr double kPairBooks = 1e-12;
inline constexpr double kPairAngularBooks = 1e-10;

/// Position error of a sphere at an impact with another sphere, relative to the smaller radius and to the sphere's path
/// along walls in the step. Such a path consists of arcs. At an impact, the arcs are planned again up to the time of
/// impact. An arc turns by at most kMaxArcAngle. The two plans therefore differ by up to kMaxArcAngle^4 / 120, which is
/// 8e-7 of the path. The largest observed difference is 3e-7. On turning surfaces, the plans differ by up to 2.5e-7
/// radii (at 3 rad/s and half a metre from the axis, in steps of 2 ms). With a smaller value, the error of arcs would
/// be reported. With a larger value, impacts of spheres that do not touch would not be found. Local: a tolerance of the
/// audit, which does not affect the run.
inline constexpr double kBoundGap = 1e-6;

/// Contact law between spheres, against which impacts are audited.
struct ImpactAudit {
    double restitution = 1.0;
    double friction = 0.0;
    double rolling_friction = 0.0;
    double resting_speed = 0.0;  ///< in m/s; if the restitution is below 1, slower rebounds are set to zero
    /// True if paths are parabolas of a uniform force. Spheres then touch at the impact up to rounding.
    bool has_exact_paths = true;
    /// Contact law between spheres of two materials. Its index in by_materials is first * materials + second.
    struct Pair {
        double restitution = 1.0;
        double friction = 0.0;
        double rolling_friction = 0.0;
        double falls_from = 0.0;   ///< in m/s; the restitution falls above this approach speed; 0: it does not fall
        double falls_with = 0.25;  ///< exponent of this fall
    };
    std::size_t materials = 0;  ///< number of materials; 0: the members above apply to all spheres
    std::vector<Pair> by_materials = {};
    double falls_from = 0.0;  ///< as in Pair, if the members above apply to all spheres
    double falls_with = 0.25;
};

/// Returns true if the audit finds an error in the impact.
[[nodiscard]] bool is_wrong(const PairMeeting& meeting, const ImpactAudit& books);

}  // namespace ricochet::verify
