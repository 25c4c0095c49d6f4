#include "ricochet/geometry/acceleration/triangle_clusters.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/quad.h"

namespace ricochet {
namespace {

/// Bound on the rounding of every quantity below, relative to the product of the bounds on its factors: at most forty
/// roundings of 2^-53. Local: an error bound of this arithmetic.
constexpr double kRounding = 0x1p-46;

/// Factor for the rounding of lengths and margins. Local: an error bound of this arithmetic.
constexpr double kLengthRounding = 1.0 + 0x1p-40;

/// Least squared length, in m^2, with a reciprocal far inside the range of doubles. Local: a guard against its end.
constexpr double kLeastSquare = 1e-280;

/// Relative rounding of a fraction of a path. Local: an error bound of this arithmetic.
constexpr double kFractionRounding = 0x1p-44;

/// Numbers that cover the underflow of squares, in m or m^2, and of products of three lengths, in m^3. Local: guards
/// against the end of the range of doubles.
constexpr double kRootUnderflow = 1e-150;
constexpr double kVolumeUnderflow = 1e-300;

double size_of(const Vec3& a) { return std::fabs(a.x) + std::fabs(a.y) + std::fabs(a.z); }

/// Four vectors and one vector for all lanes.
RICOCHET_INLINE Quad dot(const Vec3& a, const QuadVec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
RICOCHET_INLINE QuadVec3 cross(const Vec3& a, const QuadVec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

RICOCHET_INLINE Quad length_of(const QuadVec3& a) { return root(length_squared(a)) + quad_of(kRootUnderflow); }
RICOCHET_INLINE Quad size_of(const QuadVec3& a) { return abs(a.x) + abs(a.y) + abs(a.z); }

/// Lowest and highest number of each lane.
struct QuadRange {
    Quad low;
    Quad high;
};

RICOCHET_INLINE QuadRange range_of(const Quad& a, const Quad& b) { return {smaller(a, b), larger(a, b)}; }
RICOCHET_INLINE QuadRange range_of(const Quad& a, const Quad& b, const Quad& c) {
    return {smaller(smaller(a, b), c), larger(larger(a, b), c)};
}
/// Four triangles (a, b, c), relative to the start of a path.
struct QuadTriangle {
    QuadVec3 a, b, c;
    Quad edge;   ///< bound on the edges' lengths, in m
    Quad reach;  ///< bound on the sum of the magnitudes of each corner's components, in m
};

/// The part of a path that passes each triangle, as seen along the chord.
struct PathPart {
    Quad begin, end;  ///< in fractions of the path
    QuadRange bow;    ///< of f (1 - f); only for curved paths
};

/// Heights of the path's part above the planes of four triangles, times the lengths of their normals.
struct QuadHeights {
    QuadVec3 normal;
    Quad begin, end;  ///< at the ends of the part
    Quad bulge;       ///< between the part and its chord; only for curved paths
    Quad rounding;
    Quad most;  ///< bound within which the tube may touch the triangles
};

RICOCHET_INLINE QuadVec3 corner_of(const TriangleCluster& cluster, std::size_t k) {
    const auto& [x, y, z] = cluster.corners[k];
    return {load_quad(x.data()), load_quad(y.data()), load_quad(z.data())};
}

RICOCHET_INLINE QuadTriangle seen_from(const Vec3& p, const TriangleCluster& cluster) {
    const QuadVec3 origin{quad_of(p.x), quad_of(p.y), quad_of(p.z)};
    QuadTriangle seen;
    seen.a = corner_of(cluster, 0) - origin;
    seen.b = corner_of(cluster, 1) - origin;
    seen.c = corner_of(cluster, 2) - origin;
    seen.edge = load_quad(cluster.edge);
    seen.reach = size_of(seen.a) + 2.0 * seen.edge;
    return seen;
}

/// Returns the range of f (1 - f) for f in [begin, end].
RICOCHET_INLINE QuadRange bow_of(const Quad& begin, const Quad& end) {
    const Quad half = quad_of(0.5);
    QuadRange bow = range_of(begin * (quad_of(1.0) - begin), end * (quad_of(1.0) - end));
    bow.high = select((begin < half) & (end > half), quad_of(0.25), bow.high);
    return bow;
}

/// Returns the part of the path that can be near each triangle. It is empty (begin > end) for triangles that are
/// certainly before or beyond the path.
RICOCHET_INLINE PathPart part_along(const QuadTriangle& triangle, const Tube& tube) {
    PathPart part{quad_of(0.0), quad_of(1.0), {}};
    if (tube.per_squared_length > 0.0) {
        const auto [nearest, farthest] =
            range_of(dot(tube.along, triangle.a), dot(tube.along, triangle.b), dot(tube.along, triangle.c));
        const Quad beside = quad_of(tube.beside) + tube.rounding * triangle.reach;
        const Quad low = tube.per_squared_length * (nearest - beside - quad_of(tube.most_ahead));
        const Quad high = tube.per_squared_length * (farthest + beside - quad_of(tube.least_ahead));
        part.begin = select(low > 0.0, low, part.begin);
        part.end = select(high < part.end, high, part.end);
    }
    part.bow = tube.is_straight ? QuadRange{part.begin, part.begin} : bow_of(part.begin, part.end);
    return part;
}

/// Returns the lanes that the tube certainly passes outside an edge. The volume of an edge and two points of a line has
/// the sign of the side on which the line passes the edge. The volumes of the three edges add up to a number that has
/// the right sign. So a line beyond an edge has volumes of both signs, whatever the winding. For a curved path, the
/// line is parallel to the chord, and the volumes are those of all its positions.
RICOCHET_INLINE QuadMask misses_edges(const QuadTriangle& triangle, const PathPart& part, const Tube& tube) {
    const auto& [a, b, c, edge, reach] = triangle;
    const QuadVec3 along_a = cross(tube.along, a);
    const QuadVec3 along_b = cross(tube.along, b);
    const Quad ab = dot(along_a, b);
    const Quad bc = dot(along_b, c);
    const Quad ca = -dot(along_a, c);
    const Quad bound =
        tube.beside * edge + tube.rounding * (reach * (reach + quad_of(tube.size))) + quad_of(kVolumeUnderflow);
    QuadRange of_ab{ab, ab};
    QuadRange of_bc{bc, bc};
    QuadRange of_ca{ca, ca};
    if (!tube.is_straight) {
        const Vec3 across = cross(tube.along, tube.curve);
        const auto& [low, high] = part.bow;
        const Quad change_ab = dot(across, b - a);
        const Quad change_bc = dot(across, c - b);
        const Quad change_ca = -(change_ab + change_bc);
        of_ab = range_of(ab + change_ab * low, ab + change_ab * high);
        of_bc = range_of(bc + change_bc * low, bc + change_bc * high);
        of_ca = range_of(ca + change_ca * low, ca + change_ca * high);
    }
    const Quad least = smaller(smaller(of_ab.high, of_bc.high), of_ca.high);
    const Quad most = larger(larger(of_ab.low, of_bc.low), of_ca.low);
    return (least < -bound) & (most > bound);
}

RICOCHET_INLINE QuadHeights heights_above(const TriangleCluster& cluster, const QuadTriangle& triangle,
                                          const PathPart& part, const Tube& tube) {
    const QuadVec3 corner = corner_of(cluster, 0);
    QuadHeights heights;
    heights.normal = cross(corner_of(cluster, 1) - corner, corner_of(cluster, 2) - corner);
    const Quad start = dot(heights.normal, triangle.a);
    const Quad slope = dot(tube.along, heights.normal);
    heights.begin = part.begin * slope - start;
    heights.end = part.end * slope - start;
    heights.bulge = quad_of(0.0);
    if (!tube.is_straight) {
        const Quad curve = dot(tube.curve, heights.normal);
        const Quad span = part.end - part.begin;
        heights.begin = heights.begin - part.begin * (quad_of(1.0) - part.begin) * curve;
        heights.end = heights.end - part.end * (quad_of(1.0) - part.end) * curve;
        heights.bulge = 0.25 * (span * span * curve);
    }
    heights.rounding =
        kRounding * (triangle.edge * triangle.edge * (triangle.reach + quad_of(tube.size))) + quad_of(kVolumeUnderflow);
    heights.most = tube.margin * length_of(heights.normal) + heights.rounding;
    return heights;
}

/// Returns the lanes whose planes the path certainly does not reach.
RICOCHET_INLINE QuadMask misses_plane(const QuadHeights& heights) {
    const QuadRange ends = range_of(heights.begin, heights.end);
    const Quad low = ends.low - larger(heights.bulge, quad_of(0.0));
    const Quad high = ends.high - smaller(heights.bulge, quad_of(0.0));
    return (low > heights.most) | (high < -heights.most);
}

/// Returns the lanes that the tube certainly passes sideways: in the direction that is in the triangle's plane and
/// perpendicular to the chord.
RICOCHET_INLINE QuadMask misses_sideways(const QuadTriangle& triangle, const QuadHeights& heights, const PathPart& part,
                                         const Tube& tube) {
    const QuadVec3 side = cross(tube.along, heights.normal);
    const QuadRange corners = range_of(dot(side, triangle.a), dot(side, triangle.b), dot(side, triangle.c));
    const Quad bound = tube.margin * size_of(side) + tube.size * heights.rounding + quad_of(kVolumeUnderflow);
    QuadRange path{quad_of(0.0), quad_of(0.0)};
    if (!tube.is_straight) {
        const Quad curve = -dot(tube.curve, side);
        path = range_of(curve * part.bow.low, curve * part.bow.high);
    }
    return (corners.low > path.high + bound) | (corners.high < path.low - bound);
}

/// Writes the intervals in which the path is within the margin of the planes.
RICOCHET_INLINE void write_intervals(const QuadHeights& heights, const PathPart& part, TubeIntervals& intervals) {
    const Quad slope = heights.end - heights.begin;
    const Quad per_slope = 1.0 / slope;
    const Quad most = heights.most + abs(heights.bulge);
    const QuadRange near = range_of((-most - heights.begin) * per_slope, (most - heights.begin) * per_slope);
    const QuadMask is_inclined = abs(slope) > heights.rounding;
    const Quad one = quad_of(1.0);
    const Quad low = near.low - kFractionRounding * (one + abs(near.low));
    const Quad high = near.high + kFractionRounding * (one + abs(near.high));
    const Quad first = select(is_inclined & (low > 0.0), smaller(low, one), quad_of(0.0));
    const Quad last = select(is_inclined & (high < one), larger(high, quad_of(0.0)), one);
    const Quad span = part.end - part.begin;
    store((1.0 - kFractionRounding) * (part.begin + first * span), intervals.enter.data());
    store(smaller((1.0 + kFractionRounding) * (part.begin + last * span), one), intervals.leave.data());
}

RICOCHET_INLINE unsigned used_lanes(const TriangleCluster& cluster) {
    unsigned bits = 0;
    for (std::size_t lane = 0; lane < 4; ++lane) bits |= cluster.triangle[lane] != kNoTriangle ? 1U << lane : 0U;
    return bits;
}

/// Tests four triangles for directions that separate them from the tube.
RICOCHET_INLINE unsigned overlapping_lanes(const TriangleCluster& cluster, const Tube& tube, TubeIntervals& intervals) {
    const QuadTriangle triangle = seen_from(tube.from, cluster);
    const PathPart part = part_along(triangle, tube);
    const QuadMask beside = (part.begin > part.end) | misses_edges(triangle, part, tube);
    unsigned left = ~bits_of(beside) & 0xFU;
    if (left == 0) return 0;
    const QuadHeights heights = heights_above(cluster, triangle, part, tube);
    left &= used_lanes(cluster) & ~bits_of(misses_plane(heights) | misses_sideways(triangle, heights, part, tube));
    if (left != 0) write_intervals(heights, part, intervals);
    return left;
}

unsigned overlapping_baseline(const TriangleCluster& cluster, const Tube& tube, TubeIntervals& intervals) {
    return overlapping_lanes(cluster, tube, intervals);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] unsigned overlapping_avx2(const TriangleCluster& cluster, const Tube& tube,
                                                  TubeIntervals& intervals) {
    return overlapping_lanes(cluster, tube, intervals);
}

[[gnu::target("avx512vl")]] unsigned overlapping_avx512(const TriangleCluster& cluster, const Tube& tube,
                                                        TubeIntervals& intervals) {
    return overlapping_lanes(cluster, tube, intervals);
}
#endif

using Version = unsigned (*)(const TriangleCluster&, const Tube&, TubeIntervals&);

Version version_for(VectorUnit unit) {
#if defined(__x86_64__)
    if (unit == VectorUnit::avx512) return overlapping_avx512;
    if (unit == VectorUnit::avx2) return overlapping_avx2;
#endif
    static_cast<void>(unit);
    return overlapping_baseline;
}

}  // namespace

Tube::Tube(const Vec3& start, const Vec3& end, double distance, const Vec3& curvature)
    : from(start),
      along(end - start),
      curve(curvature),
      margin(distance * kLengthRounding),
      size((size_of(along) + size_of(curve)) * kLengthRounding),
      rounding(kRounding * size),
      is_straight(curve == Vec3{}) {
    const double square = dot(along, along);
    const bool is_long = square > kLeastSquare;
    beside = margin * (is_long ? std::sqrt(square) * kLengthRounding : size);
    if (is_long) per_squared_length = 1.0 / square;
    if (is_straight) return;
    const double ahead = -0.25 * dot(along, curve);
    least_ahead = std::min(ahead, 0.0);
    most_ahead = std::max(ahead, 0.0);
}

unsigned TriangleCluster::overlaps(const Tube& tube, TubeIntervals& intervals) const {
    static const Version version = version_for(vector_units().back());
    return version(*this, tube, intervals);
}

unsigned TriangleCluster::overlaps(const Tube& tube, TubeIntervals& intervals, VectorUnit unit) const {
    return version_for(unit)(*this, tube, intervals);
}

Box3 TriangleCluster::box() const {
    Box3 result;
    for (const auto& [x, y, z] : corners) {
        for (std::size_t lane = 0; lane < 4; ++lane) result.include(Vec3{x[lane], y[lane], z[lane]});
    }
    return result;
}

}  // namespace ricochet
