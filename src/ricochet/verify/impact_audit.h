/// \file
/// Audit of a recorded impact between spheres. An impact passes under these conditions:
/// - The spheres touched.
/// - Impulses push and stay within the friction cone.
/// - The motion of each sphere changed by its impulses only.
/// - Momentum and angular momentum are conserved.
/// - No energy was gained, and none was lost if there is no dissipation.
#pragma once

#include <cstddef>
#include <vector>

#include "ricochet/core/pair_meeting.h"

namespace ricochet::verify {

/// Relative tolerances of the audit of an impact, for momentum and energy, and for angular momentum. They are relative
/// to the sum of the magnitudes of all terms. Reason: rounding of impulses and, if many spheres touch at once, the
/// finite number of sweeps over the contacts. Smaller: rounding is reported. Larger: wrong impulses are not found.
/// Local: a tolerance of the audit, which does not affect the run.
inline constexpr double kPairBooks = 1e-12;
inline constexpr double kPairAngularBooks = 1e-10;

/// Position error of a sphere when it meets another, relative to the smaller radius and to its path along walls in the
/// step. Reason: such a path is made of arcs, which are planned again up to the time of impact. Arcs turn by
/// kMaxArcAngle, so both plans differ by up to its fourth power over 120, which is 8e-7 of the path. The largest error
/// seen is 3e-7. On turning surfaces they differ by up to 2.5e-7 radii (at 3 rad/s and half a metre from the axis, in
/// steps of 2 ms). Smaller: the error of arcs is reported. Larger: impacts of spheres that do not touch are not found.
/// Local: a tolerance of the audit, which does not affect the run.
inline constexpr double kBoundGap = 1e-6;

/// Contact law between spheres.
struct ImpactAudit {
    double restitution = 1.0;
    double friction = 0.0;
    double rolling_friction = 0.0;
    double resting_speed = 0.0;  ///< in m/s; with a restitution below 1, slower rebounds are set to zero
    /// True if paths are the parabolas of a uniform force. At the impact spheres then touch to rounding.
    bool has_exact_paths = true;
    /// Contact law between spheres of two materials. The index in by_materials is first * materials + second.
    struct Pair {
        double restitution = 1.0;
        double friction = 0.0;
        double rolling_friction = 0.0;
    };
    std::size_t materials = 0;  ///< 0: all spheres have the law above
    std::vector<Pair> by_materials = {};
};

/// Returns true if the audit finds an error in the impact.
[[nodiscard]] bool is_wrong(const PairMeeting& meeting, const ImpactAudit& books);

}  // namespace ricochet::verify
