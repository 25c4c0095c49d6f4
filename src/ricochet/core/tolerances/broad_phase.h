/// \file
/// Tolerances of the broad phase and of the look-ahead. See core/tolerances.h.
#pragma once

namespace ricochet {

/// Margin beside a path in free flight for many steps, relative to the largest coordinate involved. Reason: it covers
/// kCandidateSlack and the rounding of kMaxLookAheadSteps steps. In each step, rounding of the position adds about
/// 2^-52. The error of the velocity has accumulated over all steps and adds about 2^-52 times their number. Smaller
/// than some 2^-38: a particle could pass a surface that a query would have found. Larger: particles near surfaces need
/// more queries.
inline constexpr double kLookAheadSlack = 0x1p-36;

/// Largest number of steps of free flight without a new query, on straight paths and on parabolas. Larger:
/// kLookAheadSlack must grow with the first constant. With a larger second one a parabola would be longer than one
/// query can cover with the boxes' margin.
inline constexpr int kMaxLookAheadSteps = 4096;
inline constexpr int kMaxLookAheadStepsCurved = 256;

/// Distance by which paths may leave the chords of broad-phase queries, as a fraction of the mean triangle's box. The
/// first value is the general one. The second one applies to look-ahead along parabolas, and limits its length.
/// Smaller: more chords for a path next to surfaces, more queries along it. Larger: boxes overlap more. Measured: 1/16
/// and 1/8 are alike in hail; 1/16 is a tenth faster for sliding debris; 1/4 is slower in both; 1/8 costs gas 10 %. No
/// result depends on them.
inline constexpr double kChordMargin = 1.0 / 32;
inline constexpr double kLookAheadMargin = 1.0 / 16;

/// Least chord margin, as a fraction of the box of all triangles and of a sphere's radius. It applies if triangles are
/// tiny or points. Smaller: paths next to tiny triangles are cut into an excessive number of chords. Larger: boxes
/// overlap more if triangles are much smaller than the scene. No result depends on it.
inline constexpr double kLeastChordMargin = 0x1p-26;

/// Rounding of positions in a distance field, in cells. Reason: positions are rounded to some 2^-50 of the largest
/// coordinate, and a cell is at least kSmallestDistanceCell of it. The grid's thousand cells add as much rounding
/// again. Smaller than some 2^-18: a triangle could be nearer than the lower bound. Larger: bounds are that much
/// smaller.
inline constexpr double kDistanceFieldRounding = 0x1p-10;

/// Smallest edge of a distance field's cell, relative to the largest coordinate. Smaller than some 2^-36: see
/// kDistanceFieldRounding. Larger: small meshes far from the origin get no field, and curved paths near them need
/// several queries.
inline constexpr double kSmallestDistanceCell = 0x1p-30;

/// Distance to the path beyond which a candidate triangle is culled, relative to the largest coordinate involved. It
/// applies to the triangle, its box and its plane. It is also the sine of the angle at which a path leads away from a
/// plane. Reason: it covers the displacement of safe positions (2^-40) and the rounding of points on the path. Smaller:
/// a certificate could miss a triangle near a safe position. Larger: more triangles reach the narrow phase.
inline constexpr double kCandidateSlack = 0x1p-39;

/// Rounding of a point on a path, relative to the largest coordinate that the path's terms reach: some ten roundings of
/// 2^-53. If it exceeds the boxes' margin, all triangles are candidates. Steps of free flight that lead a sphere away
/// from a triangle by less than this may lead it back. Smaller: a sphere could pass through such a triangle.
inline constexpr double kPathRounding = 0x1p-48;

/// Growth of the boxes in Embree, in units of 2^-24 times the scene's largest centred coordinate. Reason: covers
/// rounding of the ray's origin, of its direction and of t * direction in single precision on each axis. Smaller than
/// about 8: Embree might not propose a touched triangle, and particles could leak.
inline constexpr double kBoxPaddingUnits = 16.0;

/// Additional growth of boxes, as a fraction of the half extent; kCandidateSlack of the largest world coordinate is
/// added too. Reason: safe positions and rounded points of a path lie beside the segments of a query. Smaller: paths
/// that reach far beyond the mesh need every triangle as a candidate sooner (at kBoxSlack / kPathRounding half extents,
/// 2^28).
inline constexpr double kBoxSlack = 0x1p-20;

}  // namespace ricochet
