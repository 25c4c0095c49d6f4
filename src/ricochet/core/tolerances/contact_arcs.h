/// \file
/// Tolerances of curved-contact integration: turns of friction and of surfaces, arcs and chords. See core/tolerances.h.
#pragma once

namespace ricochet {

/// Largest turn, in rad, of the direction of sliding or of slip within one contact interval. Friction keeps the
/// direction at the middle of the interval. Smaller: more segments (each costs a query). Larger: the end of a slide
/// depends on the time step by the angle's square.
inline constexpr double kMaxHeadingTurn = 0.05;

/// The same limit for a slip that is so slow that its direction turns within a small part of the step. Smaller: more
/// segments for each reversal of a slip. Larger: the start of a slip depends on the time step.
inline constexpr double kMostHeadingTurn = 0.5;

/// Largest relative change of the slip velocity in one arc, if its direction turns. Reason: as for kMaxArcAngle.
/// Smaller: more arcs at the end of every slip. Larger: the end of a slide depends on the time step.
inline constexpr double kMaxSlipChange = 0.1;

/// Largest turn of friction, in rad, in an interval of constant acceleration. Beyond it, and up to kMaxHeadingTurn, the
/// motion is integrated like an arc. Reason: the error of the midpoint rule is the angle's square divided by 24.
/// Smaller: more cost. Larger: the end of a slide depends on the time step.
inline constexpr double kMostStraightTurn = 1e-3;

/// Sine of the angle between friction's directions at the start and in the middle of a contact interval below which
/// they count as equal. Smaller: rounding causes a second solution of the contact problem. Larger: slow turns add up.
inline constexpr double kStraightHeading = 0x1p-44;

/// Turn, in rad, of a particle around an edge or a curved surface in one straight segment of sliding or rolling. It
/// applies to the rollback response and to particles along flows. Smaller: more segments (each costs a query). Larger:
/// the particle leaves the surface by more (angle^2 / 2 of the radius of curvature) before it falls back.
inline constexpr double kMaxChordAngle = 0.01;

/// Angle, in rad, by which a particle turns around an edge or along a curved surface in one arc. Reason: the error of
/// an arc is the fifth power of the angle. Smaller: more arcs (each costs a query). Larger: paths of swings and rolls
/// are less exact.
inline constexpr double kMaxArcAngle = 0.1;

/// Turn, in rad, of a curved surface under a sphere in one arc. Above it the arc is searched for a jump of the nearest
/// point. Reason: planned arcs turn by kMaxArcAngle. Smaller: whole arcs are searched and cut. Larger: a sphere wider
/// than a shape passes through the side that its nearest point has jumped to.
inline constexpr double kMostTurn = 2.0 * kMaxArcAngle;

/// Turn, in rad, or path, in radii, that counts as a jump between two times 2^-40 of an arc apart. The start of an arc
/// is tested for a jump too. A jump means that the surface is narrower than the sphere, which jams. Smaller: fast turns
/// jam. Larger: small jumps are missed.
inline constexpr double kJump = 1e-3;

/// Largest relative correction of an arc's end that conserves its energy. Reason: the error of the method is far
/// smaller, and a larger correction would hide other mistakes. Smaller: slow turning points are left uncorrected.
/// Larger: such mistakes are hidden.
inline constexpr double kMostEnergyCorrection = 1e-2;

/// Largest turn, in rad, of surfaces of different frames, or of curved surfaces, under a particle that they support
/// together, in one interval of contact. Reason: within an interval the surfaces are replaced by their planes at its
/// start, and the error is the square of the turn. Smaller: more intervals (each costs a query), and a step's limit of
/// intervals is reached sooner. Larger: contact with several frames at once is less exact.
inline constexpr double kMostSharedTurn = 0.02;

/// Phase, in rad, of a swing about a position of rest in one arc. Reason: with 0.45 the axial speed of a swing across a
/// cylinder has an error of 1e-3, and with this value 1e-5. The correction of the energy takes its share from that
/// speed. Smaller: more arcs. Larger: swings are less exact.
inline constexpr double kMaxArcPhase = 2.0 * kMaxArcAngle;

/// Ratio of two durations of a contact interval, up to which the plan is accepted: planned with the forces at its
/// start, and in its middle. Reason: up to this ratio the forces differ from those in the true middle by an error of
/// second order in the duration, like that of the midpoint rule. Smaller: more plans per interval. Larger: forces that
/// change quickly are followed less exactly.
inline constexpr double kSameMiddle = 1.25;

/// Number of equal intervals of a step that are not shortened further for a turn of friction. It is the usual value of
/// 1 / FrictionLimits::shortest. Smaller: turning friction is followed less exactly. Larger: more intervals.
inline constexpr double kShortestIntervals = 32.0;

/// Smallest speed of a flow along a round surface, as a fraction of its free speed, that sets the length of a chord.
/// Reason: beside a stagnation point the flow soon becomes faster. Smaller: chords there are too long. Larger: slow
/// flows need more chords.
inline constexpr double kSlowFlow = 0.1;

/// Number of chords in one step after which kMaxChordAngle is doubled, and most doublings. Reason: 500 chords of 0.01
/// rad turn by only 5 rad, and fast flows would spend the budget. Fewer chords or more doublings: long paths around
/// surfaces are less exact. The reverse: the budget ends sooner.
inline constexpr int kChordsToDouble = 64;
inline constexpr int kMostChordDoublings = 4;

}  // namespace ricochet
