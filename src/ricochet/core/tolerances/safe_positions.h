/// \file
/// Tolerances of safe positions and of certified segments, including births among moving bodies. See core/tolerances.h.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Contact offset: distance between a safe position and the surface that was hit, in ulp of the contact point's largest
/// coordinate. Reason: rounding cannot put the safe position on the surface, and the offset is too small to be visible.
/// Smaller: certificates fail more often. Larger: each impact adds g * offset to an elastic ball's energy per mass.
inline constexpr double kContactOffsetUlps = 16.0;

/// Smallest contact offset, in m. It applies only to contact points at the origin. It must exceed
/// kSmallestExactCoordinate.
inline constexpr double kSmallestContactOffset = 0x1p-240;

/// Number of times that a contact offset is increased if its certificate fails, and the factor of each increase.
inline constexpr int kSafePositionAttempts = 4;
inline constexpr double kContactOffsetWidening = 4.0;

/// Largest distance between a contact point and a safe position that is tried, in ulp of the point's largest
/// coordinate. It is 2^-40 of the coordinate, less than kCandidateSlack, so the candidates found before cover every
/// position. Smaller: sharp wedges, in which the distance from both walls grows slowly along the bisector, have fewer
/// safe positions.
inline constexpr double kLargestContactOffsetUlps = 4096.0;

/// Largest overlap of a sphere at a contact that safe_position() corrects, as a fraction of the radius. The overlap is
/// the radius less the distance of the centre from the surface. A larger overlap means that the sphere has started in
/// overlap, and it keeps its position. Smaller: grazing contacts are not corrected. Larger: a sphere born in a slight
/// overlap is pushed out.
inline constexpr double kContactMismatch = 1e-9;

/// Largest number of times that a path is halved while its chords are certified. 2^-52 of the path is below the
/// rounding of its points. A chord that still intersects a triangle at this depth is treated as an impact at that
/// position.
inline constexpr int kCertificateDepth = 52;

/// Smallest core of a sphere in overlap, as a fraction of its radius. The core is the smaller, concentric sphere that
/// does not overlap. With a smaller core the sphere collides as a point. Reason: friction acts on the spin at the
/// surface of the core, and a tiny core would scale its effect up. Smaller: rounding of the contact offset acts as
/// curvature. Larger: friction exerts no torque on spheres that are nearly half behind a surface.
inline constexpr double kSmallestCore = 0x1p-20;

/// Relative difference up to which a triangle's rim may be farther than its face and still count as equally near.
/// Reason: the limit is about ten roundings. Smaller: the rim already counts as nearest for points that are 1e-8 of the
/// distance inside it. Larger: no effect, because the exact test decides.
inline constexpr double kRimTie = 0x1p-48;

/// Overlap of a sphere with a surface up to which its segment is accepted, relative to radius plus coordinates. Reason:
/// distances and safe positions are rounded to a few 1e-16 of the coordinates, and a sphere at a safe position must
/// pass. Smaller (below about 1e-15): safe positions fail their own certificate. Larger: spheres may sink in further.
/// The tolerance never lets a centre pass a surface, because the exact certificate of the centre's segment decides
/// that.
inline constexpr double kSphereTolerance = 1e-12;

/// Part of sphere_tolerance() that a certified segment may use. Reason: a slow sphere stops at this limit, and its
/// later rounding errors must stay within the whole tolerance. Smaller: safe positions fail their own certificate
/// sooner. Larger: a sphere at rest fails its certificate by rounding.
inline constexpr double kUsedSphereTolerance = 0.5;

/// Smallest ratio of two distances to a surface, after and before a segment, for which the segment does not count as an
/// approach. It applies to a sphere in overlap, and to a sphere that touches a deforming triangle. Reason: a smaller
/// decrease of the distance is rounding. Smaller: a sphere sinks in over many steps. Larger: rounding stops spheres in
/// overlap.
inline constexpr double kNearerStill = 1.0 - 0x1p-49;

/// Decrease of the distance between a sphere in overlap and a deforming triangle that counts as rounding, as a part of
/// sphere_tolerance(). Reason: if coordinates are much larger than the distance, their rounding changes the distance.
/// Smaller: rounding stops such a sphere. Larger: the sphere sinks in further with each segment.
inline constexpr double kOverlapRounding = 0x1p-9;

/// Contact offset in a moving frame. The unit is the difference between a local position and the result of its
/// transformation to the world and back. Reason: an attached particle is transformed several times before it touches a
/// surface, and each transformation rounds its position. Smaller: attached particles lose their distance from the
/// surface by rounding. Larger: attached particles keep a wider gap.
inline constexpr double kCarryingOffsets = 8.0;

/// Largest number of times that the path of an attached particle is halved to make every segment free in all other
/// frames. Smaller: attached particles stop at obstacles sooner. Larger: particles carried into an obstacle take more
/// time.
inline constexpr int kCarryDepth = 16;

/// Clearances from the surfaces of a frame that a particle gets before a body carries it. The unit is the rounding of
/// its stored position in that frame. The clearances are tried in order. Smaller: attached particles stop at surfaces
/// beside them. Larger: attached particles are displaced further.
inline constexpr std::array<double, 4> kCarryingClearances{8.0, 64.0, 512.0, 4096.0};

/// Distance, as a fraction of the largest coordinate, within which a moving body counts as near a position at birth.
/// Reason: several bodies that displace a newborn particle, one after the other, move it by less than this distance.
/// Smaller: an overlap with a second body could be missed. Larger: each birth queries more bodies.
inline constexpr double kBirthReach = 0x1p-30;

/// Distance, in contact offsets, by which a birth on a moving surface is displaced along the normal. Reason: the
/// displacement must survive rounding in the frames of several bodies. Smaller: such particles start in contact.
/// Larger: such particles start further from the surface.
inline constexpr double kBirthOffsets = 4.0;

/// One minus the cosine of the angle between normals below which a safe position is moved away from both surfaces along
/// one normal. Smaller: nearly equal normals make the displacement ill-conditioned. Larger: a blunt edge counts as
/// flat.
inline constexpr double kSameSafeNormal = 1e-9;

/// Returns the distance from |x| to the next larger double. x must be finite.
[[nodiscard]] inline double ulp(double x) {
    const double magnitude = std::fabs(x);
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(magnitude) + 1) - magnitude;
}

/// Returns the contact offset at a contact point, in m. The offset depends only on the point's own coordinates, so its
/// bits do not depend on the number of triangles in a wall.
[[nodiscard]] inline double contact_offset(const Vec3& contact) {
    return std::max(kContactOffsetUlps * ulp(max_abs(contact)), kSmallestContactOffset);
}

/// Returns the overlap, in m, that a certified segment of a sphere may have. radius and largest_coordinate are in m.
[[nodiscard]] inline double sphere_tolerance(double radius, double largest_coordinate) {
    return kSphereTolerance * (radius + largest_coordinate);
}

}  // namespace ricochet
