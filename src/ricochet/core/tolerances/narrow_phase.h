/// \file
/// Tolerances of the narrow phase: simultaneous contacts, seams between triangles, and approach. See core/tolerances.h.
#pragma once

namespace ricochet {

/// Difference of times, in ulp, below which impacts are simultaneous. All surfaces hit at one time, as in a corner, are
/// resolved together.
inline constexpr double kSimultaneousUlps = 4.0;

/// Limit of one minus the cosine of the angle between the normal of a face and that of its edge or vertex. It applies
/// if a sphere hits both simultaneously. Below the limit the edge or vertex counts as a part of the face and is
/// ignored. Reason: the face and the edge have the same rounded time of impact if the closest point is within sqrt(2 *
/// rounding * radius) of the edge. For coordinates of a thousand radii this distance corresponds to an angle of 1e-6.
/// Smaller: edges inside a flat surface deflect a grazing sphere. Larger: blunt real edges act as faces.
inline constexpr double kSeamTurn = 1e-11;

/// Lateral distance up to which a sphere that touches an edge or a vertex also touches the adjacent face. It is
/// relative to the largest coordinate involved. Reason: near the seam of a flat plate, rounding decides which triangle
/// has the closest point. The sphere must still bounce as on a plate without a seam. Smaller than about 2^-50: seams of
/// flat plates deflect spheres by rounding. Larger: at a convex edge the error of the normal is up to this length over
/// the radius.
inline constexpr double kSeamSlack = 0x1p-48;

/// Least approach speed of a sphere that already overlaps a surface, as a fraction of the sphere's speed. A slower
/// sphere does not count as approaching. Reason: rounding gives a velocity along the surface a normal component, which
/// must not stop the sphere repeatedly. Larger: a sphere that overlaps at birth can sink in by a larger fraction of its
/// path.
inline constexpr double kMinApproach = 0x1p-48;

/// Rounding of a pseudonormal, and of its scalar product with a unit vector, relative to the sum of the weights of the
/// face normals. Normals of a smaller length count as cancelled, and a smaller product leaves the side undecided.
/// Reason: a hundred triangles around a vertex add a few roundings of 2^-50, and one of 2^-53 each. Smaller: rounding
/// decides between the sides of very sharp edges. Larger: edges sharper than this angle, in rad, have no sides.
inline constexpr double kPseudonormalRounding = 0x1p-44;

/// Approach speed towards a deforming triangle, as a fraction of the relative speed, below which a point moves along
/// the triangle. Reason: the limit covers rounding of the normal and of the velocity. Smaller: sliding points hit the
/// triangle again by rounding. Larger: only the certificate finds slow approaches.
inline constexpr double kDeformingGraze = 1e-12;

/// Fraction of a path during which a point that leaves a deforming triangle does not hit it again. Reason: at the start
/// the point is within rounding of the triangle. Smaller: the triangle is hit again at the start. Larger: an impact
/// with a fast triangle is found late, but the certificate still stops the point.
inline constexpr double kShortLeave = 0x1p-20;

/// Fraction of the distance to a deforming triangle below which a sphere in overlap counts as nearer. Reason: the
/// difference exceeds the rounding of the distance. Smaller: such a sphere sinks in further before it stops. Larger:
/// rounding counts as an impact.
inline constexpr double kNearerFraction = 1.0 - 0x1p-40;

/// Smallest gap to a moving triangle that does not count as contact, as a fraction of the contact offset. Reason: the
/// gap of a safe position is a whole offset, and rounding reduces it by less than three quarters. Smaller: the search
/// for a contact takes longer. Larger: particles at safe positions count as in contact.
inline constexpr double kLeastGap = 0.25;

/// Separation below which a sphere is in contact with an analytic shape, as a fraction of the error bound of the
/// distance. Reason: no larger error has been observed. Smaller: the search for the time of impact may not end at a
/// contact. Larger: contacts are found earlier.
inline constexpr double kShapeContact = 0.25;

}  // namespace ricochet
