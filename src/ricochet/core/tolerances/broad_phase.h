/// \file
/// Tolerances of the broad phase and of the look-ahead. See core/tolerances.h.
#pragma once

namespace ricochet {

/// Margin beside a path in free flight for many steps, relative to the largest coordinate involved. Reason: it covers
/// kCandidateSlack and the rounding of kMaxLookAheadSteps steps. In each step, rounding of the position adds about
/// 2^-52. Rounding of the velocity accumulates over the steps and adds about 2^-52 times their number. Smaller than
/// about 2^-38: a particle could pass a surface that a query would have found. Larger: particles near surfaces need
/// more queries.
inline constexpr double kLookAheadSlack = 0x1p-36;

/// Largest number of steps of free flight without a new query, on straight paths (first constant) and on parabolas
/// (second constant). First constant larger: kLookAheadSlack must grow with it. Second constant larger: parabolas
/// become longer than the boxes' margin can cover in one query.
inline constexpr int kMaxLookAheadSteps = 4096;
inline constexpr int kMaxLookAheadStepsCurved = 256;

/// Distance by which paths may leave the chords of broad-phase queries, as a fraction of the mean size of a triangle's
/// box. The first constant applies in general. The second one applies to the look-ahead along parabolas, and limits its
/// length. Smaller: paths next to surfaces need more chords and more queries. Larger: boxes overlap more. Measured:
/// 1/16 and 1/8 take equal time in the hail scene. For sliding debris 1/16 is 10 % faster than 1/8. 1/4 is slower than
/// both in both scenes. 1/8 makes the gas scene 10 % slower. No result depends on these constants.
inline constexpr double kChordMargin = 1.0 / 32;
inline constexpr double kLookAheadMargin = 1.0 / 16;

/// Least chord margin, as a fraction of the box of all triangles and of a sphere's radius. It applies if triangles are
/// tiny or have shrunk to points. Smaller: paths next to tiny triangles are divided into too many chords. Larger: boxes
/// overlap more if triangles are much smaller than the scene. No result depends on this constant.
inline constexpr double kLeastChordMargin = 0x1p-26;

/// Rounding of positions in a distance field, in cells. Reason: positions are rounded to about 2^-50 of the largest
/// coordinate. A cell measures at least kSmallestDistanceCell of that coordinate. Cell numbers of up to a thousand
/// double the rounding. Smaller than about 2^-18: a triangle could be nearer than the lower bound. Larger: lower bounds
/// decrease by the same amount.
inline constexpr double kDistanceFieldRounding = 0x1p-10;

/// Smallest edge of a distance field's cell, relative to the largest coordinate. Smaller than about 2^-36: the rounding
/// exceeds kDistanceFieldRounding. Larger: small meshes far from the origin get no distance field, and curved paths
/// near these meshes need several queries.
inline constexpr double kSmallestDistanceCell = 0x1p-30;

/// Distance to the path beyond which a candidate triangle is culled, relative to the largest coordinate involved. The
/// limit applies to the triangle, its box and its plane. It is also the smallest sine of the angle at which a path
/// counts as leading away from a plane. Reason: the limit covers the displacement of safe positions (2^-40) and the
/// rounding of points on the path. Smaller: a certificate could miss a triangle near a safe position. Larger: more
/// triangles reach the narrow phase.
inline constexpr double kCandidateSlack = 0x1p-39;

/// Rounding of a point on a path, relative to the largest coordinate that the path's terms reach: about ten roundings
/// of 2^-53. If this rounding exceeds the boxes' margin, all triangles are candidates. A sphere that recedes from a
/// triangle by less than this rounding may come back to it in free flight. Smaller: a sphere could pass through such a
/// triangle.
inline constexpr double kPathRounding = 0x1p-48;

/// Growth of the boxes in Embree, in units of 2^-24 times the scene's largest centred coordinate. Reason: the growth
/// covers the single-precision rounding of the ray's origin, of its direction and of t * direction on each axis.
/// Smaller than about 8: Embree might not propose a touched triangle, and particles could leak.
inline constexpr double kBoxPaddingUnits = 16.0;

/// Additional growth of boxes, as a fraction of the half extent. The boxes also grow by kCandidateSlack times the
/// largest world coordinate. Reason: safe positions and rounded points of a path can be beside the segments of a query.
/// The rounding of a path exceeds this growth if the path reaches kBoxSlack / kPathRounding = 2^28 half extents beyond
/// the mesh. Such a path is tested against every triangle. Smaller: this happens at a shorter distance.
inline constexpr double kBoxSlack = 0x1p-20;

}  // namespace ricochet
