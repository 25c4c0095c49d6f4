/// \file
/// Tolerances of the narrow phase: simultaneous contacts, seams between triangles, and approach. See core/tolerances.h.
#pragma once

namespace ricochet {

/// Difference of times, in ulp, below which impacts are simultaneous: all surfaces hit are then resolved together
/// (corners).
inline constexpr double kSimultaneousUlps = 4.0;

/// One minus the cosine of the angle between the normals of a face and of an edge or vertex. It applies if a sphere
/// hits both at the same time. Below it the edge is the face's own seam and is ignored. Reason: the face and the edge
/// have the same rounded time of impact while the closest point is within sqrt(2 * rounding * radius) of the edge. For
/// coordinates of a thousand radii this is an angle of 1e-6. Smaller: a grazing sphere is deflected by flat inner
/// edges. Larger: blunt real edges act as faces.
inline constexpr double kSeamTurn = 1e-11;

/// Lateral distance up to which a sphere that touches an edge or a vertex also touches the face beside it. It is
/// relative to the largest coordinate involved. Reason: near the seam of a flat plate, rounding decides which triangle
/// has the closest point. The sphere must still bounce as off one plate. Smaller than some 2^-50: seams of flat plates
/// deflect by rounding errors. Larger: on a convex edge the normal is wrong by up to this length over the radius.
inline constexpr double kSeamSlack = 0x1p-48;

/// Least approach speed of a sphere that already overlaps a surface, as a fraction of its speed. A slower sphere does
/// not count as approaching. Reason: a velocity along the surface has a normal component of rounding errors, which must
/// not stop the sphere repeatedly. Larger: a sphere that overlaps at birth can sink in by that fraction of its path.
inline constexpr double kMinApproach = 0x1p-48;

/// Rounding of a pseudonormal, relative to the sum of the weights of its face normals, and of its scalar product with a
/// unit vector. Reason: a few roundings of 2^-50 and one of 2^-53 for each of some hundred triangles around a vertex.
/// Below it normals count as cancelled and sides as undecided. Smaller: rounding decides between the sides of knife
/// edges. Larger: edges sharper than that (rad) have no sides.
inline constexpr double kPseudonormalRounding = 0x1p-44;

/// Distance, as a fraction of the largest coordinate, below which the points at which one segment crosses neighbouring
/// triangles are one crossing. Reason: through an edge a segment crosses two triangles at points that differ only by
/// rounding. Smaller: such a crossing counts twice, and the parity of an open surface shows no crossing. Larger: the
/// two faces of a thinner plate count as one.
inline constexpr double kSameCrossing = 1e-9;

/// Approach speed towards a deforming triangle, as a fraction of the relative speed, below which a point moves along
/// the triangle. Reason: rounding of the normal and of the velocity. Smaller: sliding points hit the triangle again by
/// rounding. Larger: slow approaches are left to the certificate.
inline constexpr double kDeformingGraze = 1e-12;

/// Fraction of a path during which a point that leaves a deforming triangle does not hit it again. Reason: at the start
/// the point is within rounding of the triangle. Smaller: the triangle is hit again at the start. Larger: fast
/// triangles are met late; the certificate still stops the point.
inline constexpr double kShortLeave = 0x1p-20;

/// Fraction of the distance to a deforming triangle at which a sphere in overlap counts as nearer. Reason: more than
/// the rounding of the distance. Smaller: such a sphere sinks in further before it is stopped. Larger: rounding counts
/// as an impact.
inline constexpr double kNearerLink = 1.0 - 0x1p-40;

/// Smallest gap to a moving triangle that is no contact, as a fraction of the contact offset. Reason: safe positions
/// keep a whole offset, and rounding takes less than the rest. Smaller: contacts are searched for longer. Larger:
/// particles at safe positions count as in contact.
inline constexpr double kLeastGap = 0.25;

/// Separation below which a sphere is in contact with an analytic shape, as a fraction of the error bound of the
/// distance. It is the largest error observed. Smaller: the search for the time of impact may not end at a contact.
/// Larger: contacts are found earlier by as much.
inline constexpr double kShapeContact = 0.25;

}  // namespace ricochet
