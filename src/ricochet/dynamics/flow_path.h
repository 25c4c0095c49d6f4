/// \file
/// First-order motion: the path of a particle that goes with a flow, x' = g(x, t), by the integrators that have a
/// meaning there.
#pragma once

#include "ricochet/dynamics/flight.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// A piece of way with a flow.
struct FlowPath {
    Path path;
    double next_duration = 0.0;  ///< s that an adaptive method would try next; 0: no idea
};

/// True for the methods of first-order motion: forward_euler, midpoint, rk4 and dormand_prince. The others step
/// position and velocity separately and have no meaning here.
[[nodiscard]] bool carries_along_flows(IntegratorKind kind);

/// The way from a place at a time over `duration` seconds (> 0); dormand_prince may end it earlier, at the end of its
/// first sub-step, for which it tries `first` seconds. Throws InputError for a method that has no meaning here.
///
/// forward_euler is a straight line with the flow's velocity at the start (first order). midpoint (second order) and
/// rk4 (fourth) make their ordinary step; the path is the cubic Hermite polynomial through both ends with the flow's
/// velocities there, whose error is of fourth order in the duration. dormand_prince halves its step until the embedded
/// estimate of its error and the distance between that cubic and the method's own interpolant in the middle of the
/// step, where it is largest, are within the tolerance of the position; that of the velocity plays no role. Sources: as
/// in integrator.h; interpolant: L. F. Shampine, "Some practical Runge-Kutta formulas", Mathematics of Computation 46,
/// 1986.
[[nodiscard]] FlowPath flow_path(const Integrator& integrator, const FlowField& flow, const Vec3& position, double time,
                                 double duration, double first);

}  // namespace ricochet
