/// \file
/// Tolerances of integrators, forces and coupled particles, and limits of the arithmetic. See core/tolerances.h.
#pragma once

#include <cstdint>

namespace ricochet {

/// Correction of a velocity at which Newton's method for the implicit step has converged, relative to the largest speed
/// in the system. Reason: convergence is quadratic near the solution, so the remaining error is far below this
/// correction. Rounding of the forces (about 1e-16 times the stiffness number) must not prolong the iteration. Smaller:
/// stiff systems never report convergence. Larger: the equation of the implicit step is solved less exactly; stability
/// is not affected.
inline constexpr double kNewtonTolerance = 1e-10;

/// Energy from integration errors at which the run stops as diverged, as a multiple of all energy from forces and
/// walls. Reason: errors of stable methods stay below the energy from forces and walls. Errors of unstable methods
/// exceed any bound within a few steps. Smaller: coarse but stable runs are stopped. Larger: more invalid output is
/// written before the stop.
inline constexpr double kDivergedGain = 100.0;

/// Strain of springs up to which their energy counts as rounding if nothing else moves. Smaller than about 1e-8: the
/// rounding in a network at rest counts as divergence. Larger: divergence from perfect rest is detected later.
inline constexpr double kNegligibleStretch = 1e-6;

/// Smallest tolerance, in m and m/s, of the adaptive integrator `dormand_prince`. Reason: the number of sub-steps is
/// proportional to the inverse fifth root of the tolerance. Smaller: a step never ends. Larger: systems of 1e-15 m and
/// less cannot be integrated accurately.
inline constexpr double kSmallestTolerance = 1e-30;

/// Shortest sub-step of an adaptive method, as a fraction of the step. A sub-step of this duration is accepted even if
/// its error exceeds the tolerance, and the particle's step is counted in `coarse_steps`. Reason: at a jump of a force,
/// the error is then 2^-48 of the jump's effect in a step. Near a point of infinite force no sub-step is short enough.
/// Smaller: the time, which is rounded to 2^-53, does not advance. Larger: close passages of point masses are less
/// accurate.
inline constexpr double kShortestSubstep = 0x1p-48;

/// Largest number of sub-steps of an adaptive method in one step of a particle. The rest of the step is not simulated,
/// and is counted in `budget_exhausted`. Reason: so many sub-steps take some tenths of a second. Smaller: particles in
/// close orbits about a point mass need about 50 sub-steps per orbit, and stop for a part of each step. Larger: such a
/// step takes longer before it ends.
inline constexpr std::uint32_t kMostSubsteps = 100000;

/// Error of an adaptive sub-step that counts as zero, relative to the largest component of the state. Reason: this is a
/// quarter of the component's rounding. Smaller: sub-steps shorten without end if the tolerance is below the precision
/// of doubles. Larger: the integrator does not meet tolerances that it could meet.
inline constexpr double kStateRounding = 0x1p-54;

/// Distance, in m, below which two particles count as coincident. No direction from one to the other is then defined,
/// so the forces between them are zero. Reason: the third power of this distance is still a normal number, with some
/// margin. Smaller (from 1e-102 on): the inverse third power overflows. Larger: no effect on real scenes.
inline constexpr double kCoincidentDistance = 1e-100;

/// Largest speed, in m/s, to which forces may accelerate a particle: the speed of light (exact by the definition of the
/// metre). Reason: a higher speed means that the forces are wrong or that the step is too long for them, so the run
/// stops. The limit does not apply to particles that start with a higher speed.
inline constexpr double kMaxSpeed = 299792458.0;

/// Largest coordinate of a mesh or plane, in m, and largest state of a particle before it is frozen. Reason: the
/// predicates multiply three coordinates and must not overflow. They are exact up to 2^300 m.
inline constexpr double kLargestCoordinate = 1e75;

/// Smallest size of a surface, in m: the extent of a mesh, the diameter and height of a shape. Reason: coordinates
/// below kSmallestExactCoordinate count as zero, and this threshold is far below the rounding of such a surface.
/// Products of four lengths, with their errors in double-double, stay normal numbers. The smallest contact offset is
/// less than 1e-12 of the size. Smaller (from 1e-70 on): areas of triangles underflow to 0, and particles and rays miss
/// the triangles. Larger: no effect on real scenes.
inline constexpr double kSmallestSize = 1e-60;

/// Largest coefficient of a path, in m/s^k, with which the path is used. Reason: a cubic between two positions in a
/// very short time has coefficients of the size of distance / time^3. Sums of the squares of coefficients must not
/// overflow in the narrow phase. Larger: the narrow phase computes NaN and finds no roots, so that only the certificate
/// protects the path. Smaller (from 1e40 on): valid paths of short arcs are refused.
inline constexpr double kLargestPathCoefficient = 1e120;

/// Least mass of a particle, in kg, fragments included. Reason: inertia (0.4 m r^2), momentum and kinetic energy of
/// slow and small particles have to stay normal numbers. A fragment's mass is a whole multiple of the last bit of the
/// parent's mass, which must not be 0. Smaller (from 1e-308 on): masses of fragments become 0 or NaN. Larger: no effect
/// on real scenes.
inline constexpr double kSmallestMass = 1e-300;

/// Unit of the per-triangle impulse totals, in N s. Totals are 128-bit integers in this unit, so that sums do not
/// depend on the order. The largest total is 2^27 N s = 1.3e8 N s. A larger total wraps.
inline constexpr double kImpulseUnit = 0x1p-100;

/// Least excess of a rope's length over the distance of its ends, as a fraction of the length. With at least this
/// excess the rope starts as a catenary. Ropes with a smaller excess start straight. Smaller (below about 1e-14):
/// rounding determines the catenary's parameter. Larger: nearly taut ropes start shorter than their length.
inline constexpr double kTautRope = 1e-9;

/// Horizontal distance of a rope's ends, relative to the rope's length, below which the rope starts straight down and
/// back up. Smaller than about 1e-300: exponentials overflow. Larger: narrow catenaries lose their curvature.
inline constexpr double kFoldedRope = 1e-9;

/// Largest turn, in rad, in one piece of a path in a cloud. It limits the turn of the cloud, and the phase of the
/// oscillation of particles that are pulled back to their positions. Reason: the cubic of a piece deviates from the arc
/// by at most angle^4 / 384 (1e-5) of its radius, and ends on the arc. Smaller: more pieces. Larger: particles hit
/// walls beside the arc.
inline constexpr double kMostCloudTurn = 0.25;

/// Largest turn, as defined for kMostCloudTurn, in one step of the run, in rad. Scenes with a larger turn are refused.
/// Reason: one step then needs 64 pieces. Larger: a step may take an unlimited time.
inline constexpr double kMostCloudTurnOfStep = 16.0;

/// Largest number of Newton iterations of the implicit step of one particle. After that the last iterate is used.
/// Smaller: stiff steps are solved less exactly. Larger: steps that do not converge take more time.
inline constexpr int kMostNewtonSteps = 20;

/// Largest number of times that the implicit step of a system is halved if its equations are not solved. After that the
/// last iterate of the whole step is used and counted. Smaller: steps that converge badly are less exact. Larger: these
/// steps take more time.
inline constexpr int kMostHalvedSteps = 10;

/// Largest error per step of the logarithm of the temperature excess in radiative cooling. Smaller: the limit
/// approaches the rounding, which halving of the step does not reduce. Larger: the sum of the errors of all steps in a
/// run is visible.
inline constexpr double kCoolingError = 1e-11;

/// Remainder of a run's duration, as a fraction of a step, that is added to the last step. Reason: users intend
/// duration / time_step to be a whole number. Smaller: rounding adds a very short step. Larger: the last step can be
/// longer.
inline constexpr double kStepRounding = 1e-6;

/// Smallest part of a step that is tried if the support of coupled particles does not settle. Smaller: steps that do
/// not settle take more time. Larger: springs gain energy from wrong predictions.
inline constexpr double kLeastCoupledPart = 0x1p-6;

/// Energy that springs may gain from errors of the predicted positions, as a fraction of the kinetic energy without
/// springs. Smaller: more predictions and shorter substeps. Larger: energy may grow by a larger fraction.
inline constexpr double kPredictionEnergy = 1e-5;

/// Energy that springs may gain from errors of the predicted positions on curved surfaces, as a fraction of the energy
/// that the step dissipates. Smaller: more predictions. Larger: the springs return more of the dissipated energy.
inline constexpr double kPredictionLoss = 0.1;

/// Smallest length of the component of a surface's normal perpendicular to the normals of earlier constraints. If the
/// component is shorter, the surface adds no constraint to the prediction of coupled particles. Smaller: rounding adds
/// constraints. Larger: surfaces at small angles count as one.
inline constexpr double kIndependentSupport = 1e-6;

/// Tolerance of Newton's method that replaces kNewtonTolerance until the supports of coupled particles are known.
/// Smaller: more iterations for predictions that are discarded. Larger: supports are found from less exact motions.
inline constexpr double kRoughNewtonTolerance = 1e-5;

/// Smallest compliance of friction at the supports of coupled particles, see PlannedContacts::find(). The first
/// constant applies until the supports are known, and the second one afterwards. Reason: with ten times the second
/// value, springs of 1e8 N/m gained 0.8 J in a step. Smaller: more iterations. Larger: sticking particles creep, and
/// springs gain energy.
inline constexpr double kRoughFrictionYield = 1e-3;
inline constexpr double kFrictionYield = 1e-4;

}  // namespace ricochet
