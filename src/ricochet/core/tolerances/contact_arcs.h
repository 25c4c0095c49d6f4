/// \file
/// Tolerances of curved-contact integration: turns of friction and of surfaces, arcs and chords. See core/tolerances.h.
#pragma once

namespace ricochet {

/// Largest turn, in rad, of the direction of sliding or of slip within one contact interval. Friction keeps the
/// direction at the middle of the interval. Smaller: more segments, each of which needs a query. Larger: the end of a
/// slide depends on the time step, by an error proportional to the angle's square.
inline constexpr double kMaxHeadingTurn = 0.05;

/// Like kMaxHeadingTurn, for a slip that is so slow that its direction turns within a small part of the step. Smaller:
/// more segments for each reversal of a slip. Larger: the start of a slip depends on the time step.
inline constexpr double kMostHeadingTurn = 0.5;

/// Largest relative change of the slip velocity in one arc, if the direction of slip turns. Reason: as for
/// kMaxArcAngle. Smaller: more arcs at the end of every slip. Larger: the end of a slide depends on the time step.
inline constexpr double kMaxSlipChange = 0.1;

/// Largest turn of the friction force, in rad, in an interval of constant acceleration. For a larger turn, up to
/// kMaxHeadingTurn, the motion is integrated like an arc. Reason: the error of the midpoint rule is the angle's square
/// divided by 24. Smaller: more intervals are integrated. Larger: the end of a slide depends on the time step.
inline constexpr double kMostStraightTurn = 1e-3;

/// Sine of the angle between friction's directions at the start and in the middle of a contact interval below which
/// both directions count as equal. Smaller: rounding alone makes a second solution of the contact problem necessary.
/// Larger: errors of slow turns add up.
inline constexpr double kStraightHeading = 0x1p-44;

/// Turn, in rad, of a particle around an edge or a curved surface in one straight segment of sliding or rolling. It
/// applies to the rollback response and to particles along flows. Smaller: more segments, each of which needs a query.
/// Larger: the particle rises further above the surface, by angle^2 / 2 of the radius of curvature, before it falls
/// back.
inline constexpr double kMaxChordAngle = 0.01;

/// Angle, in rad, by which a particle turns around an edge or along a curved surface in one arc. Reason: the error of
/// an arc is proportional to the fifth power of the angle. Smaller: more arcs, each of which needs a query. Larger:
/// paths of swinging and rolling particles are less exact.
inline constexpr double kMaxArcAngle = 0.1;

/// Turn, in rad, of a curved surface's normal under a sphere in one arc. If an arc turns by more, the nearest point of
/// the surface may have jumped, and the arc is searched for the jump. Reason: planned arcs turn by kMaxArcAngle.
/// Smaller: arcs without a jump are searched and shortened. Larger: the nearest point jumps unnoticed, and a sphere
/// wider than a shape passes through its other side.
inline constexpr double kMostTurn = 2.0 * kMaxArcAngle;

/// Turn of a surface, in rad, or displacement of a sphere, in radii, that counts as a jump if it occurs within 2^-40 of
/// an arc's duration. The start of an arc is also tested for a jump. A jump means that the surface is narrower than the
/// sphere, and the sphere jams. Smaller: fast turns jam. Larger: small jumps are missed.
inline constexpr double kJump = 1e-3;

/// Largest relative correction of the state at the end of an arc, which restores the energy. Reason: the error of the
/// method is far smaller, and a larger correction would hide other errors. Smaller: slow turning points are not
/// corrected. Larger: other errors are hidden.
inline constexpr double kMostEnergyCorrection = 1e-2;

/// Largest turn, in rad, of surfaces in one contact interval. It applies to surfaces of different frames, and to curved
/// surfaces, that support a particle together. Reason: within an interval each surface is replaced by its tangent plane
/// at the start, and the error is the square of the turn. Smaller: more intervals, each of which needs a query, so a
/// step reaches its limit of intervals sooner. Larger: contact with several frames at once is less exact.
inline constexpr double kMostSharedTurn = 0.02;

/// Largest change of phase, in rad, in one arc of an oscillation about a position of rest. Reason: a value of 0.45
/// gives the axial speed of an oscillation across a cylinder an error of 1e-3. With 0.2 the error is 1e-5. The energy
/// correction causes this error, because it also changes the axial speed. Smaller: more arcs. Larger: oscillations are
/// less exact.
inline constexpr double kMaxArcPhase = 2.0 * kMaxArcAngle;

/// Largest ratio of two planned durations of a contact interval for which the plan is accepted. One plan uses the
/// forces at the start, and the other one those in the middle. Reason: up to this ratio the error of the forces in the
/// middle is of second order in the duration, like that of the midpoint rule. Smaller: more plans per interval. Larger:
/// forces that change quickly are integrated less exactly.
inline constexpr double kSameMiddle = 1.25;

/// Duration of a step divided by FrictionLimits::shortest, the duration down to which contact intervals are shortened
/// because friction turns. Smaller: turning friction is integrated less exactly. Larger: more intervals.
inline constexpr double kShortestIntervals = 32.0;

/// Smallest speed that is assumed for a flow along a round surface to compute the duration of a chord. It is a fraction
/// of the free speed of the flow. Reason: near a stagnation point the flow accelerates within a short path. Smaller:
/// chords there are too long. Larger: slow flows need more chords.
inline constexpr double kSlowFlow = 0.1;

/// Number of chords in one step after which kMaxChordAngle is doubled, and largest number of doublings. Reason: 500
/// chords of 0.01 rad turn by only 5 rad, so fast flows would use up the budget. Fewer chords or more doublings: long
/// paths around surfaces are less exact. More chords or fewer doublings: the budget is used up sooner.
inline constexpr int kChordsToDouble = 64;
inline constexpr int kMostChordDoublings = 4;

}  // namespace ricochet
