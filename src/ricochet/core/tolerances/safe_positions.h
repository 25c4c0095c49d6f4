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
/// coordinate. Reason: rounding cannot put the safe position on the surface, and the offset stays invisible. Smaller:
/// certificates fail more often. Larger: each impact adds g * offset to an elastic ball's energy per mass.
inline constexpr double kContactOffsetUlps = 16.0;

/// Smallest contact offset, in m; matters only at the very origin. Must stay above kSmallestExactCoordinate.
inline constexpr double kSmallestContactOffset = 0x1p-240;

/// Number of times that a contact offset is widened if its certificate fails, and the factor.
inline constexpr int kSafePositionAttempts = 4;
inline constexpr double kContactOffsetWidening = 4.0;

/// Largest distance between a contact point and a safe position that is tried, in ulp of the point's largest
/// coordinate. It is 2^-40 of the coordinate, inside kCandidateSlack, so the candidates already gathered cover every
/// position. Smaller: sharp wedges, whose bisector leaves both walls slowly, have fewer safe positions.
inline constexpr double kLargestContactOffsetUlps = 4096.0;

/// Largest shortfall of a sphere's distance at a contact, as a fraction of the radius, that safe_position() corrects.
/// With a larger one the sphere has started in overlap and keeps its position. Smaller: grazing contacts are not
/// corrected. Larger: a sphere born in a slight overlap is pushed out.
inline constexpr double kContactMismatch = 1e-9;

/// Depth to which a path is halved while its chords are certified. 2^-52 of the path is below the rounding of its
/// points. A chord that still intersects a triangle at this depth is treated as an impact at that position.
inline constexpr int kCertificateDepth = 52;

/// Smallest core of a sphere in overlap, as a fraction of its radius. With a smaller core the sphere collides as a
/// point. Reason: the spin acts at the surface of the core, and would be scaled up there. Smaller: rounding of the
/// contact offset acts as curvature. Larger: spheres that are nearly half behind a surface lose friction's torque.
inline constexpr double kSmallestCore = 0x1p-20;

/// Relative difference up to which a triangle's rim may be farther than its face and still count as equally near.
/// Reason: some ten roundings. Smaller: the rim counts within 1e-8 of the distance inside. Larger: no effect, because
/// the exact test decides.
inline constexpr double kRimTie = 0x1p-48;

/// Overlap of a sphere with a surface up to which its segment is accepted, relative to radius plus coordinates. Reason:
/// distances and safe positions are rounded to a few 1e-16 of the coordinates, and a sphere at a safe position must
/// pass. Smaller (below some 1e-15): safe positions fail their own certificate. Larger: spheres may sink in by that
/// much. It never lets a centre through, because the exact certificate of the centre's segment decides that.
inline constexpr double kSphereTolerance = 1e-12;

/// Part of sphere_tolerance() that a certified segment may use. Reason: a slow sphere stops right at this limit, and
/// its later rounding errors must stay within the whole tolerance. Smaller: safe positions fail their own certificate
/// sooner. Larger: a sphere at rest fails its certificate by rounding.
inline constexpr double kUsedSphereTolerance = 0.5;

/// Smallest ratio of distances to a surface, after and before a segment, that does not count as approach. It applies to
/// a sphere in overlap, and to one that touches a deforming triangle. Reason: a smaller decrease is rounding. Smaller:
/// a sphere sinks in over many steps. Larger: rounding stops spheres in overlap.
inline constexpr double kNearerStill = 1.0 - 0x1p-49;

/// Decrease of the distance to a deforming triangle that a sphere in overlap may show, as a part of sphere_tolerance().
/// Reason: coordinates that are large beside the distance are rounded. Smaller: rounding stops such a sphere. Larger:
/// it sinks in by as much per segment.
inline constexpr double kOverlapRounding = 0x1p-9;

/// Contact offset in a moving frame, in differences between a local position and its image after one round trip to the
/// world. Reason: a particle is carried several times before it comes to a surface, and each time rounds its position.
/// Smaller: carried particles lose their distance from the surface by rounding. Larger: they keep a wider gap.
inline constexpr double kCarryingOffsets = 8.0;

/// Depth to which the path of a particle that a body carries is halved, until every segment is free in all other
/// frames. Smaller: carried particles stop at obstacles sooner. Larger: particles carried into an obstacle cost more.
inline constexpr int kCarryDepth = 16;

/// Clearances from the surfaces of a frame that a particle gets before a body carries it, in roundings of its stored
/// position there. Each is tried after the one before. Smaller: carried particles stop at surfaces beside them. Larger:
/// they are displaced further.
inline constexpr std::array<double, 4> kCarryingClearances{8.0, 64.0, 512.0, 4096.0};

/// Distance, as a fraction of the largest coordinate, within which a moving body counts as near a position at birth.
/// Reason: several bodies that displace a particle in turn move it by less. Smaller: an overlap with a second body
/// could be missed. Larger: more bodies are queried for each birth.
inline constexpr double kBirthReach = 0x1p-30;

/// Distance, in contact offsets, by which a birth on a moving surface is displaced along the normal. Reason: the
/// displacement must survive rounding in the frames of several bodies. Smaller: such particles start in contact.
/// Larger: they start further from the surface.
inline constexpr double kBirthOffsets = 4.0;

/// One minus the cosine of the angle between normals below which a safe position is moved away from both surfaces along
/// one normal. Smaller: nearly equal normals make the displacement ill-conditioned. Larger: a blunt edge counts as
/// flat.
inline constexpr double kSameSafeNormal = 1e-9;

/// Returns the distance from x, which is finite, to the next larger double magnitude.
[[nodiscard]] inline double ulp(double x) {
    const double magnitude = std::fabs(x);
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(magnitude) + 1) - magnitude;
}

/// Returns the contact offset at a contact point, in m. It depends only on the point's own coordinates, so that a wall
/// of two or of two million triangles gives the same bits.
[[nodiscard]] inline double contact_offset(const Vec3& contact) {
    return std::max(kContactOffsetUlps * ulp(max_abs(contact)), kSmallestContactOffset);
}

/// Returns the overlap that a certified segment of a sphere may show, in m. radius and largest_coordinate are in m.
[[nodiscard]] inline double sphere_tolerance(double radius, double largest_coordinate) {
    return kSphereTolerance * (radius + largest_coordinate);
}

}  // namespace ricochet
