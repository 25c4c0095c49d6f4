/// \file
/// Tolerances of integrators, forces and coupled particles, and limits of the arithmetic. See core/tolerances.h.
#pragma once

#include <cstdint>

namespace ricochet {

/// Correction of a velocity at which Newton's method for the implicit step has converged, relative to the largest speed
/// in the system. Reason: convergence is quadratic near the solution, so the remaining error is far below it. Rounding
/// of the forces (some 1e-16 times the stiffness number) must not prolong the iteration. Smaller: stiff systems never
/// report convergence. Larger: the end of the step solves its equation less exactly; stability is not affected.
inline constexpr double kNewtonTolerance = 1e-10;

/// Energy created by the integrator at which the run stops as diverged, as a multiple of all energy from forces and
/// walls. Reason: errors of stable methods stay below that energy, and explosions pass any bound within a few steps.
/// Smaller: coarse but stable runs are stopped. Larger: more invalid output is written before the stop.
inline constexpr double kDivergedGain = 100.0;

/// Strain of springs whose energy counts as rounding if nothing else moves. Smaller than some 1e-8: a network at rest
/// counts as diverged by its own rounding. Larger: explosions from perfect rest are detected later.
inline constexpr double kNegligibleStretch = 1e-6;

/// Smallest tolerance, in m and m/s, of the integrator that chooses its own steps. Reason: the number of substeps grows
/// with the inverse fifth root of the tolerance. Smaller: a step never ends. Larger: systems of 1e-15 m and less could
/// not be followed accurately.
inline constexpr double kSmallestTolerance = 1e-30;

/// Shortest substep of an adaptive method, as a fraction of its step. If its error still exceeds the tolerance, it is
/// accepted and its particle-step is counted (coarse_steps). Reason: a particle passes a jump of a force with an error
/// of 2^-48 of the jump's effect in a step. No substep is short enough near a point of infinite force. Smaller: the
/// clock, which rounds to 2^-53 of the time, does not advance. Larger: close passages of point masses lose their
/// accuracy earlier.
inline constexpr double kShortestSubstep = 0x1p-48;

/// Largest number of substeps of an adaptive method in one step of a particle. The rest of the step is not simulated,
/// and is counted (budget_exhausted). Reason: some tenths of a second of work. Smaller: particles bound close to a
/// point mass, which need some 50 substeps per orbit, stop for a part of each step. Larger: a step takes longer before
/// it ends.
inline constexpr std::uint32_t kMostSubsteps = 100000;

/// Error of an adaptive substep that counts as zero, relative to the largest component of the state: a quarter of its
/// rounding. Smaller: substeps shorten without end if the tolerance is below the precision of doubles. Larger: the
/// integrator does not meet tolerances that it could meet.
inline constexpr double kStateRounding = 0x1p-54;

/// Distance, in m, below which particles coincide and have no direction between them: forces between them are zero.
/// Reason: its third power is the smallest that is still a normal number with margin. Smaller (from 1e-102 on): the
/// inverse cube overflows. Larger: no effect on real scenes.
inline constexpr double kSamePlace = 1e-100;

/// Speed that forces may not exceed, in m/s: the speed of light (exact by the definition of the metre). Reason: a
/// higher speed means that the forces are wrong or the step is too long for them, so the run stops. Particles that
/// start faster are left alone.
inline constexpr double kMaxSpeed = 299792458.0;

/// Largest coordinate of a mesh or plane, in m, and largest state of a particle before it is frozen. Reason: the
/// predicates multiply three coordinates and must not overflow; far inside kLargestExactCoordinate.
inline constexpr double kLargestCoordinate = 1e75;

/// Smallest size of a surface, in m: the extent of a mesh, the diameter and height of a shape. Reason: coordinates
/// below kSmallestExactCoordinate count as zero, and that is far below the rounding of such a surface. Products of four
/// lengths, with their errors in double-double, stay normal numbers. The smallest contact offset is less than 1e-12 of
/// the size. Smaller (from 1e-70 on): triangles lose their areas to underflow, and particles and rays miss them.
/// Larger: no effect on real scenes.
inline constexpr double kSmallestSize = 1e-60;

/// Largest coefficient of a path, in m/s^k, that is followed. Reason: a cubic between two positions within a nearly
/// zero time has coefficients of their distance over the cube of that time. Sums of their squares must not overflow in
/// the narrow phase. Larger: the narrow phase finds no roots among values that are not numbers, and only the
/// certificate protects the path. Smaller (from 1e40 on): short arcs that can be followed are not.
inline constexpr double kLargestPathCoefficient = 1e120;

/// Least mass of a particle, in kg, fragments included. Reason: inertia (0.4 m r^2), momentum and kinetic energy of
/// slow and small particles have to stay normal numbers. A share of a mass is a whole multiple of its last bit, which
/// must not be 0. Smaller (from 1e-308 on): masses of fragments become 0 or not a number. Larger: no effect on real
/// scenes.
inline constexpr double kSmallestMass = 1e-300;

/// Unit of the per-triangle impulse totals, in N s. Totals are 128-bit integers in this unit, so that sums do not
/// depend on the order. The largest total is 2^27 N s = 1.3e8 N s (beyond it the total wraps).
inline constexpr double kImpulseUnit = 0x1p-100;

/// Least excess of a rope's length over the distance of its ends for a catenary, as a fraction of the length. Ropes
/// with less are laid out straight. Smaller (below some 1e-14): the catenary's parameter is rounding. Larger: nearly
/// taut ropes start shortened.
inline constexpr double kTautRope = 1e-9;

/// Sideways distance of a rope's ends, relative to its length, below which it hangs straight down and back up. Smaller
/// than some 1e-300: exponentials overflow. Larger: narrow catenaries lose their curvature.
inline constexpr double kFoldedRope = 1e-9;

/// Largest turn, in rad, in one piece of a path: of positions in a cloud, and of the swing of particles that are pulled
/// back to them. Reason: the cubic of a piece is within angle^4 / 384 of the arc, 1e-5 of its radius, and ends on it.
/// Smaller: more pieces. Larger: walls are hit beside the arc.
inline constexpr double kMostCloudTurn = 0.25;

/// Largest such turn in one step of the run, above which a scene is refused. Reason: 64 pieces. Larger: steps without
/// end.
inline constexpr double kMostCloudTurnOfStep = 16.0;

/// Most Newton iterations of the implicit step of one particle. The last iterate is then used. Smaller: stiff steps are
/// solved less exactly. Larger: steps that do not converge cost more.
inline constexpr int kMostNewtonSteps = 20;

/// Most halvings of an implicit step of a system whose equations are not solved. After that the last iterate of the
/// whole step is used and counted. Smaller: hard steps are less exact. Larger: they cost more.
inline constexpr int kMostHalvedSteps = 10;

/// Largest error of a step of the logarithm of the temperature excess in radiative cooling. Smaller: it would come near
/// to rounding, which halving does not reduce. Larger: it would show in the sum over the steps of a run.
inline constexpr double kCoolingError = 1e-11;

/// Remainder of the duration, as a fraction of a step, that is added to the last step. Reason: duration / time_step is
/// meant to be whole. Smaller: rounding adds a tiny step. Larger: the last step is longer by as much.
inline constexpr double kStepRounding = 1e-6;

/// Smallest part of a step that is tried if the support of coupled particles does not settle. Smaller: such steps cost
/// more. Larger: springs gain energy from wrong predictions.
inline constexpr double kLeastCoupledPart = 0x1p-6;

/// Energy that springs may gain from errors of the predicted positions, as a fraction of the kinetic energy without
/// springs. Smaller: more predictions and shorter substeps. Larger: energy may grow by as much.
inline constexpr double kPredictionEnergy = 1e-5;

/// Energy that springs may gain from errors of the predicted positions on curved surfaces, as a fraction of the energy
/// that the step dissipates. Smaller: more predictions. Larger: less energy is lost than should be.
inline constexpr double kPredictionLoss = 0.1;

/// Length of the component of a surface's normal across the constraints before it. Below it the surface adds no
/// constraint to the prediction of coupled particles. Smaller: rounding adds constraints. Larger: surfaces at small
/// angles count as one.
inline constexpr double kIndependentSupport = 1e-6;

/// Tolerance of Newton's method, as kNewtonTolerance, until the supports of coupled particles are known. Smaller: more
/// iterations for predictions that are discarded. Larger: supports are found from less exact motions.
inline constexpr double kRoughNewtonTolerance = 1e-5;

/// Smallest yield of friction at the supports of coupled particles, see PlannedContacts::find(): until the supports are
/// known, and afterwards. Reason: ten times the second value stretched springs of 1e8 N/m by 0.8 J in a step. Smaller:
/// more iterations. Larger: sticking particles creep, and springs gain energy.
inline constexpr double kRoughFrictionYield = 1e-3;
inline constexpr double kFrictionYield = 1e-4;

}  // namespace ricochet
