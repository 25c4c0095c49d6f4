/// \file
/// Tolerances of the equations of impacts, and of contact with friction. See core/tolerances.h.
#pragma once

#include <array>

namespace ricochet {

/// Smallest restitution of a spring and damper. Reason: restitution 0 would need unbounded damping, for which no step
/// is short enough. Smaller: the stability bound of the step decreases with the root of this value if the restitution
/// is 0. Larger: surfaces of restitution 0 rebound more.
inline constexpr double kMinPenaltyRestitution = 0.01;

/// Largest residual of solved equations of contact with friction, as a fraction of the largest rate. Forces per mass
/// and rates have the same unit. Reason: the limit is about ten times the rounding. Smaller: solved problems count as
/// unsolved. Larger: energy may grow by a larger fraction.
inline constexpr double kCoulombResidual = 0x1p-40;

/// Residual up to which a solution is accepted before less friction is tried. Reason: rounding leaves a residual of
/// 1e-7 and more if the forces between surfaces are undetermined. The next smaller friction in kTriedFriction has an
/// error of 1e-3. Smaller: a sphere that rolls between two surfaces slips for a moment. Larger: less exact solutions
/// are accepted, but the limits on their energy still apply.
inline constexpr double kNearlySolved = 1e-4;

/// Fractions of the friction with which the equations of contact are solved in turn, until one residual is below
/// kNearlySolved. Reason: if forces are undetermined, slightly less friction often has a solution. Fewer fractions:
/// spheres slip for a moment in wedges. More fractions: problems without a solution take more time.
inline constexpr std::array kTriedFriction{1.0, 0.999, 0.99, 0.9, 0.5, 0.0};

/// Residual at which the iteration stops, relative to the largest rate. Reason: this is the rounding of six products.
/// Smaller: more iterations without improvement. Larger: less exact solutions.
inline constexpr double kCoulombRounding = 0x1p-50;

/// Compliance, relative to the inertia of the particle, of contacts that count as stiff. Reason: two contacts whose
/// normals differ by the square root of this value, 1e-5, have determined loads. Proximal steps solve contacts with
/// closer normals. Smaller: the equations cannot be solved in doubles. Larger: more proximal steps.
inline constexpr double kStiffCompliance = 1e-10;

/// Factor by which the compliance decreases per stage, from soft contacts to stiff ones. The second constant is the
/// factor closest to 1 that is tried if a stage finds no solution. Reason: a factor of 1e-2 per stage fails to find the
/// solution in one case of a thousand. Smaller: stages fail more often. Larger: more stages.
inline constexpr double kStiffening = 1e-2;
inline constexpr double kShortestStiffening = 0.9;

/// Length of the difference of unit normals up to which surfaces count as one in an impact or a contact. Reason: the
/// effects of two such surfaces differ by the same fraction, far below the accuracy of a path's parabolas. The normals
/// of a flat surface's facets differ only by rounding. Smaller: nearly redundant contacts remain, whose forces are
/// ill-conditioned. Larger: a wedge of that angle supports less than it should.
inline constexpr double kSameDirection = 1e-9;

/// Rounding of twice the energy over the mass in an impact. It is a fraction of the squares of the velocity and of the
/// velocity changes by all surfaces. A smaller gain of energy counts as rounding, and scaling of the velocities removes
/// it. A larger gain lowers the restitution. Reason: the limit is about ten times the rounding of the solved equations.
/// Smaller: rounding alone lowers the restitution. Larger: scaling also removes gains by friction, which should lower
/// the restitution.
inline constexpr double kEnergyRounding = 0x1p-44;

/// Residual, relative to the largest rate, at which a stage of decreasing compliance counts as solved. Reason: the
/// solution is only the start of the next stage. Smaller: more iterations per stage. Larger: later stages start from
/// wrong forces.
inline constexpr double kCoulombStage = 1e-10;

/// Residual, relative to the largest rate, above which the iteration is aborted. Smaller: iterations that first move
/// away from the solution are aborted. Larger: iterations without a solution take more time.
inline constexpr double kHopelessResidual = 1e6;

/// Force, relative to the largest rate, above which the forces are tested for divergence as the compliance decreases.
/// The second constant applies if a stage found no solution. Reason: the rounding of such a force exceeds
/// kCoulombStage. Smaller: large but bounded forces count as diverging, and the problem is solved with less friction.
/// Larger: diverging problems take more time.
inline constexpr double kRunawayForce = 1e6;
inline constexpr double kLostForce = 1e5;

/// Smallest ratio of the displacements of compliant contacts in successive stages for which the forces count as
/// diverging. Reason: if forces are bounded, the displacements decrease with the compliance. Smaller: bounded forces
/// count as diverging. Larger: diverging problems take more time.
inline constexpr double kDivergingRatio = 0.5;

/// Relative difference between the changes of the forces in sweep n and in sweep 2 n, below which the forces grow
/// steadily and count as diverging. Reason: such forces would not converge in ten thousand sweeps. Smaller: diverging
/// problems take more time. Larger: slowly converging problems count as diverging.
inline constexpr double kSteadyChange = 1e-3;

/// Fraction of the friction for which the contact equations of a sliding sphere must have a solution. The sphere jams
/// if only a smaller fraction has a solution. Reason: if slightly less friction has a solution, rounding or a short
/// search may have missed the solution with full friction. Smaller: wedges that should jam let spheres slide. Larger:
/// rounding jams spheres.
inline constexpr double kJammingFriction = 0.95;

/// Largest number of passes over the surfaces of a corner until the particle approaches none of them. After that the
/// velocity into the corner is removed. Smaller: narrow corners absorb more energy. Larger: narrow corners take more
/// time.
inline constexpr int kCornerPasses = 16;

/// Speed at which moving surfaces may still be approached after a solved impact, as a fraction of the speeds involved.
/// Reason: the limit is far above the residual of a solution, and far below the approach speed in an unsolved impact.
/// Smaller: solved impacts count as unsolved. Larger: unsolved impacts count as solved.
inline constexpr double kImpactResidual = 1e-6;

/// Slip in an impact with a dynamic body, as a fraction of the speeds, that counts as zero. Reason: a slip of a few
/// units in the last place has no defined direction. Smaller: friction acts in a direction that consists of rounding.
/// Larger: impacts of light bodies between heavy particles never end.
inline constexpr double kSlipRounding = 0x1p-50;

}  // namespace ricochet
