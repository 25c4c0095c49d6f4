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

/// The four triangles of a cluster at once.
struct FourLanes {
    using Number = Quad;
    using Vector = QuadVec3;
    using Mask = QuadMask;

    RICOCHET_INLINE static Quad number(double all) { return quad_of(all); }
    RICOCHET_INLINE static QuadVec3 corner(const TriangleCluster& cluster, std::size_t k) {
        const auto& [x, y, z] = cluster.corners[k];
        return {load_quad(x.data()), load_quad(y.data()), load_quad(z.data())};
    }
    RICOCHET_INLINE static Quad edge(const TriangleCluster& cluster) { return load_quad(cluster.edge); }
    RICOCHET_INLINE static void store(const Quad& a, TriangleCluster::Lanes& to) { ricochet::store(a, to.data()); }
};

/// One triangle of a cluster, for processors without vectors of four doubles. Computes the same bits.
struct OneLane {
    using Number = double;
    using Vector = Vec3;
    using Mask = bool;

    static double number(double all) { return all; }
    [[nodiscard]] Vec3 corner(const TriangleCluster& cluster, std::size_t k) const {
        const auto& [x, y, z] = cluster.corners[k];
        return {x[lane], y[lane], z[lane]};
    }
    [[nodiscard]] double edge(const TriangleCluster& cluster) const { return static_cast<double>(cluster.edge[lane]); }
    void store(double a, TriangleCluster::Lanes& to) const { to[lane] = a; }

    std::size_t lane;
};

/// Four vectors and one vector for all lanes.
RICOCHET_INLINE Quad dot(const Vec3& a, const QuadVec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
RICOCHET_INLINE QuadVec3 cross(const Vec3& a, const QuadVec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

RICOCHET_INLINE Quad size_of(const QuadVec3& a) { return magnitude(a.x) + magnitude(a.y) + magnitude(a.z); }

/// Directions that may separate triangles from a tube.
template <class Lanes>
struct Separation {
    using Number = typename Lanes::Number;
    using Vector = typename Lanes::Vector;
    using Mask = typename Lanes::Mask;

    /// Lowest and highest number of each lane.
    struct Range {
        Number low;
        Number high;
    };

    RICOCHET_INLINE static Range range_of(const Number& a, const Number& b) { return {smaller(a, b), larger(a, b)}; }
    RICOCHET_INLINE static Range range_of(const Number& a, const Number& b, const Number& c) {
        return {smaller(smaller(a, b), c), larger(larger(a, b), c)};
    }
    /// The triangles (a, b, c), relative to the start of a path.
    struct Triangles {
        Vector a, b, c;
        Number edge;   ///< bound on the edges' lengths, in m
        Number reach;  ///< bound on the sum of the magnitudes of each corner's components, in m
    };

    /// The part of a path that passes each triangle, as seen along the chord.
    struct PathPart {
        Number begin, end;  ///< in fractions of the path
        Range bow;          ///< of f (1 - f); only for curved paths
    };

    /// Heights of the path's part above the planes of the triangles, times the lengths of their normals.
    struct Heights {
        Vector normal;
        Number begin, end;  ///< at the ends of the part
        Number bulge;       ///< between the part and its chord; only for curved paths
        Number rounding;
        Number most;  ///< bound within which the tube may touch the triangles
    };

    RICOCHET_INLINE static Triangles seen_from(const Vec3& p, const TriangleCluster& cluster, const Lanes& lanes) {
        const Vector origin{Lanes::number(p.x), Lanes::number(p.y), Lanes::number(p.z)};
        Triangles seen;
        seen.a = lanes.corner(cluster, 0) - origin;
        seen.b = lanes.corner(cluster, 1) - origin;
        seen.c = lanes.corner(cluster, 2) - origin;
        seen.edge = lanes.edge(cluster);
        seen.reach = size_of(seen.a) + 2.0 * seen.edge;
        return seen;
    }

    /// Returns the range of f (1 - f) for f in [begin, end].
    RICOCHET_INLINE static Range bow_of(const Number& begin, const Number& end) {
        const Number half = Lanes::number(0.5);
        Range bow = range_of(begin * (Lanes::number(1.0) - begin), end * (Lanes::number(1.0) - end));
        bow.high = select((begin < half) & (end > half), Lanes::number(0.25), bow.high);
        return bow;
    }

    /// Returns the part of the path that can be near each triangle. It is empty (begin > end) for triangles that are
    /// certainly before or beyond the path.
    RICOCHET_INLINE static PathPart part_along(const Triangles& triangle, const Tube& tube) {
        PathPart part{Lanes::number(0.0), Lanes::number(1.0), {}};
        if (tube.per_squared_length > 0.0) {
            const auto [nearest, farthest] =
                range_of(dot(tube.along, triangle.a), dot(tube.along, triangle.b), dot(tube.along, triangle.c));
            const Number beside =
                Lanes::number(tube.beside) + tube.rounding * (triangle.reach + Lanes::number(tube.size));
            const Number low = tube.per_squared_length * (nearest - beside - Lanes::number(tube.most_ahead));
            const Number high = tube.per_squared_length * (farthest + beside - Lanes::number(tube.least_ahead));
            part.begin = select(low > 0.0, low, part.begin);
            part.end = select(high < part.end, high, part.end);
        }
        part.bow = tube.is_straight ? Range{part.begin, part.begin} : bow_of(part.begin, part.end);
        return part;
    }

    /// Returns the lanes that the tube certainly passes outside an edge. The volume of an edge and two points of a line
    /// has the sign of the side on which the line passes the edge. The volumes of the three edges add up to a number
    /// that has the right sign. So a line beyond an edge has volumes of both signs, whatever the winding. For a curved
    /// path, the line is parallel to the chord, and the volumes are those of all its positions.
    RICOCHET_INLINE static Mask misses_edges(const Triangles& triangle, const PathPart& part, const Tube& tube) {
        const auto& [a, b, c, edge, reach] = triangle;
        const Vector along_a = cross(tube.along, a);
        const Vector along_b = cross(tube.along, b);
        const Number ab = dot(along_a, b);
        const Number bc = dot(along_b, c);
        const Number ca = -dot(along_a, c);
        const Number bound = tube.beside * edge + tube.rounding * (reach * (reach + Lanes::number(tube.size))) +
                             Lanes::number(kVolumeUnderflow);
        Range of_ab{ab, ab};
        Range of_bc{bc, bc};
        Range of_ca{ca, ca};
        if (!tube.is_straight) {
            const Vec3 across = cross(tube.along, tube.curve);
            const auto& [low, high] = part.bow;
            const Number change_ab = dot(across, b - a);
            const Number change_bc = dot(across, c - b);
            const Number change_ca = -(change_ab + change_bc);
            of_ab = range_of(ab + change_ab * low, ab + change_ab * high);
            of_bc = range_of(bc + change_bc * low, bc + change_bc * high);
            of_ca = range_of(ca + change_ca * low, ca + change_ca * high);
        }
        const Number least = smaller(smaller(of_ab.high, of_bc.high), of_ca.high);
        const Number most = larger(larger(of_ab.low, of_bc.low), of_ca.low);
        return (least < -bound) & (most > bound);
    }

    RICOCHET_INLINE static Heights heights_above(const TriangleCluster& cluster, const Lanes& lanes,
                                                 const Triangles& triangle, const PathPart& part, const Tube& tube) {
        const Vector corner = lanes.corner(cluster, 0);
        Heights heights;
        heights.normal = cross(lanes.corner(cluster, 1) - corner, lanes.corner(cluster, 2) - corner);
        const Number start = dot(heights.normal, triangle.a);
        const Number slope = dot(tube.along, heights.normal);
        heights.begin = part.begin * slope - start;
        heights.end = part.end * slope - start;
        heights.bulge = Lanes::number(0.0);
        if (!tube.is_straight) {
            const Number curve = dot(tube.curve, heights.normal);
            const Number span = part.end - part.begin;
            heights.begin = heights.begin - part.begin * (Lanes::number(1.0) - part.begin) * curve;
            heights.end = heights.end - part.end * (Lanes::number(1.0) - part.end) * curve;
            heights.bulge = 0.25 * (span * span * curve);
        }
        heights.rounding = kRounding * (triangle.edge * triangle.edge * (triangle.reach + Lanes::number(tube.size))) +
                           Lanes::number(kVolumeUnderflow);
        heights.most =
            tube.margin * (root(length_squared(heights.normal)) + Lanes::number(kRootUnderflow)) + heights.rounding;
        return heights;
    }

    /// Returns the lanes whose planes the path certainly does not reach.
    RICOCHET_INLINE static Mask misses_plane(const Heights& heights) {
        const Range ends = range_of(heights.begin, heights.end);
        const Number low = ends.low - larger(heights.bulge, Lanes::number(0.0));
        const Number high = ends.high - smaller(heights.bulge, Lanes::number(0.0));
        return (low > heights.most) | (high < -heights.most);
    }

    /// Returns the lanes that the tube certainly passes sideways: in the direction that is in the triangle's plane and
    /// perpendicular to the chord.
    RICOCHET_INLINE static Mask misses_sideways(const Triangles& triangle, const Heights& heights, const PathPart& part,
                                                const Tube& tube) {
        const Vector side = cross(tube.along, heights.normal);
        const Range corners = range_of(dot(side, triangle.a), dot(side, triangle.b), dot(side, triangle.c));
        const Number bound =
            tube.margin * size_of(side) + tube.size * heights.rounding + Lanes::number(kVolumeUnderflow);
        Range path{Lanes::number(0.0), Lanes::number(0.0)};
        if (!tube.is_straight) {
            const Number curve = -dot(tube.curve, side);
            path = range_of(curve * part.bow.low, curve * part.bow.high);
        }
        return (corners.low > path.high + bound) | (corners.high < path.low - bound);
    }

    /// Writes the intervals in which the path is within the margin of the planes.
    RICOCHET_INLINE static void write_intervals(const Heights& heights, const PathPart& part, const Lanes& lanes,
                                                TubeIntervals& intervals) {
        const Number slope = heights.end - heights.begin;
        const Number per_slope = 1.0 / slope;
        const Number most = heights.most + magnitude(heights.bulge);
        const Range near = range_of((-most - heights.begin) * per_slope, (most - heights.begin) * per_slope);
        const Mask is_inclined = magnitude(slope) > heights.rounding;
        const Number one = Lanes::number(1.0);
        const Number low = near.low - kFractionRounding * (one + magnitude(near.low));
        const Number high = near.high + kFractionRounding * (one + magnitude(near.high));
        const Number first = select(is_inclined & (low > 0.0), smaller(low, one), Lanes::number(0.0));
        const Number last = select(is_inclined & (high < one), larger(high, Lanes::number(0.0)), one);
        const Number span = part.end - part.begin;
        lanes.store((1.0 - kFractionRounding) * (part.begin + first * span), intervals.enter);
        lanes.store(smaller((1.0 + kFractionRounding) * (part.begin + last * span), one), intervals.leave);
    }
};

RICOCHET_INLINE unsigned used_lanes(const TriangleCluster& cluster) {
    unsigned bits = 0;
    for (std::size_t lane = 0; lane < 4; ++lane) bits |= cluster.triangle[lane] != kNoTriangle ? 1U << lane : 0U;
    return bits;
}

/// Tests the four triangles at once.
RICOCHET_INLINE unsigned overlapping_four(const TriangleCluster& cluster, const Tube& tube, TubeIntervals& intervals) {
    using Four = Separation<FourLanes>;
    constexpr FourLanes kAll;
    const Four::Triangles triangles = Four::seen_from(tube.from, cluster, kAll);
    const Four::PathPart part = Four::part_along(triangles, tube);
    const QuadMask beside = (part.begin > part.end) | Four::misses_edges(triangles, part, tube);
    unsigned left = ~bits_of(beside) & used_lanes(cluster);
    if (left == 0) return 0;
    const Four::Heights heights = Four::heights_above(cluster, kAll, triangles, part, tube);
    left &= ~bits_of(Four::misses_plane(heights) | Four::misses_sideways(triangles, heights, part, tube));
    if (left != 0) Four::write_intervals(heights, part, kAll, intervals);
    return left;
}

bool overlaps_one(const TriangleCluster& cluster, const OneLane& lane, const Tube& tube, TubeIntervals& intervals) {
    using One = Separation<OneLane>;
    const One::Triangles triangle = One::seen_from(tube.from, cluster, lane);
    const One::PathPart part = One::part_along(triangle, tube);
    if (part.begin > part.end || One::misses_edges(triangle, part, tube)) return false;
    const One::Heights heights = One::heights_above(cluster, lane, triangle, part, tube);
    if (One::misses_plane(heights) || One::misses_sideways(triangle, heights, part, tube)) return false;
    One::write_intervals(heights, part, lane, intervals);
    return true;
}

unsigned overlapping_baseline(const TriangleCluster& cluster, const Tube& tube, TubeIntervals& intervals) {
    unsigned left = used_lanes(cluster);
    for (std::size_t lane = 0; lane < 4; ++lane) {
        if ((left >> lane & 1U) != 0 && !overlaps_one(cluster, {lane}, tube, intervals)) left &= ~(1U << lane);
    }
    return left;
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] unsigned overlapping_avx2(const TriangleCluster& cluster, const Tube& tube,
                                                  TubeIntervals& intervals) {
    return overlapping_four(cluster, tube, intervals);
}

[[gnu::target("avx512vl")]] unsigned overlapping_avx512(const TriangleCluster& cluster, const Tube& tube,
                                                        TubeIntervals& intervals) {
    return overlapping_four(cluster, tube, intervals);
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
