/// \file
/// Tolerances of the equations of impacts, and of contact with friction. See core/tolerances.h.
#pragma once

#include <array>

namespace ricochet {

/// Smallest restitution of a spring and damper. Reason: a smaller one would need unbounded damping, which no step can
/// follow. Smaller: the stability bound of dead surfaces shrinks with its root. Larger: dead surfaces bounce more.
inline constexpr double kMinPenaltyRestitution = 0.01;

/// Largest residual of solved equations of contact with friction, as a fraction of the largest rate (forces per mass
/// and rates have the same unit). Reason: some ten times the rounding. Smaller: solved problems count as unsolved.
/// Larger: energy may grow by as much.
inline constexpr double kCoulombResidual = 0x1p-40;

/// Residual up to which a solution is accepted before less friction is tried. Reason: if surfaces press against each
/// other with undetermined forces, rounding leaves 1e-7 and more. The next smaller friction would be wrong by 1e-3.
/// Smaller: a sphere that rolls between two surfaces slips for a moment. Larger: less exact solutions are accepted.
/// Their energy is still limited.
inline constexpr double kNearlySolved = 1e-4;

/// Fractions of the friction with which the equations of contact are solved in turn, until one is solved up to
/// kNearlySolved. Reason: with undetermined forces a little less friction often has a solution. Fewer: spheres slip for
/// a moment in wedges. More: problems without a solution cost more.
inline constexpr std::array kTriedFriction{1.0, 0.999, 0.99, 0.9, 0.5, 0.0};

/// Residual at which the iteration stops. Reason: rounding of six products. Smaller: iterations without improvement.
/// Larger: worse solutions.
inline constexpr double kCoulombRounding = 0x1p-50;

/// Compliance, relative to the inertia of the particle, of contacts that count as stiff. Reason: normals that differ by
/// its square root, 1e-5, still determine which of two contacts carries the load. Proximal steps handle closer normals.
/// Smaller: the equations cannot be solved in doubles. Larger: more proximal steps.
inline constexpr double kStiffCompliance = 1e-10;

/// Factor by which the compliance decreases per stage from soft contacts to stiff ones: the first value, and the limit
/// when no solution is found. Reason: two digits per stage lose the solution in one case of a thousand. Smaller: it is
/// lost more often. Larger: more stages.
inline constexpr double kStiffening = 1e-2;
inline constexpr double kShortestStiffening = 0.9;

/// Length of the difference of unit normals up to which surfaces count as one in an impact or a contact. Reason: the
/// effects of two such surfaces differ by as much, far below the accuracy of a path's parabolas. The facets of a flat
/// surface, and seams, differ by rounding. Smaller: nearly redundant contacts, whose forces are ill-conditioned.
/// Larger: a wedge of that angle supports less than it should.
inline constexpr double kSameDirection = 1e-9;

/// Rounding of twice the energy over the mass in an impact. It is a fraction of the squares of the velocity and of the
/// velocity changes by all surfaces. A smaller gain is scaled away; a larger one is a real gain. Reason: some ten times
/// the rounding of the solved equations. Smaller: restitution is lowered for rounding only. Larger: a gain by friction
/// is scaled away instead of lowering the restitution.
inline constexpr double kEnergyRounding = 0x1p-44;

/// Residual, relative to the largest rate, at which a stage of decreasing compliance counts as solved. Reason: the next
/// stage only starts from it. Smaller: more iterations per stage. Larger: later stages start from forces that are
/// wrong.
inline constexpr double kCoulombStage = 1e-10;

/// Residual from which a solution is given up, relative to the largest rate. Smaller: iterations that first move away
/// from the solution are lost. Larger: lost ones cost more.
inline constexpr double kHopelessResidual = 1e6;

/// Force, relative to the largest rate, from which the forces may diverge as the compliance decreases; and the same if
/// a stage found no solution. Reason: its rounding exceeds kCoulombStage. Smaller: large but bounded forces count as
/// diverging, and the problem is solved with less friction. Larger: diverging problems cost more.
inline constexpr double kRunawayForce = 1e6;
inline constexpr double kLostForce = 1e5;

/// Smallest ratio of the displacements of compliant contacts, from one stage to the next, for which the forces diverge.
/// Reason: displacements of bounded forces shrink with the compliance. Smaller: bounded forces count as diverging.
/// Larger: diverging problems cost more.
inline constexpr double kSteadyGiving = 0.5;

/// Relative difference between the changes in two sweeps, the second after twice as many, below which forces grow
/// steadily and diverge. Reason: they would not settle in ten thousand sweeps. Smaller: diverging problems cost more.
/// Larger: slowly converging ones are given up.
inline constexpr double kSteadyChange = 1e-3;

/// Fraction of its friction with which a sliding sphere must have a solution. It jams if only less friction has one.
/// Reason: if only slightly less friction has a solution, rounding or a short search may have missed the solution with
/// full friction. Smaller: wedges that should jam let spheres slide. Larger: rounding jams spheres.
inline constexpr double kJammingFriction = 0.95;

/// Most passes over the surfaces of a corner until none is approached. After that the velocity into the corner is
/// removed. Smaller: narrow corners absorb more energy. Larger: they cost more.
inline constexpr int kCornerPasses = 16;

/// Speed at which moving surfaces may still be approached after a solved impact, as a fraction of the speeds involved.
/// Reason: far above the residual of a solution, and far below the approach of an unsolved one. Smaller: solved impacts
/// count as unsolved. Larger: the reverse.
inline constexpr double kImpactResidual = 1e-6;

/// Slip in an impact with a dynamic body, as a fraction of the speeds, that counts as zero. Reason: a few units in the
/// last place, which have no direction. Smaller: friction acts along rounding. Larger: light bodies between heavy
/// particles never reach the end of their impacts.
inline constexpr double kSlipRounding = 0x1p-50;

}  // namespace ricochet
