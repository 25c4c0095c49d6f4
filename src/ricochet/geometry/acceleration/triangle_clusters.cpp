#include "ricochet/geometry/acceleration/triangle_clusters.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "ricochet/core/box3.h"
#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

constexpr float kExtent = TriangleCluster::kExtent;

/// Bound on the difference between a corner and its quantised position, in units of the cluster. Along an axis the
/// difference is at most half a unit, or one unit at the largest number, which is not a power of two. Local: an error
/// bound of this arithmetic.
constexpr double kCornerRounding = 2.0;

/// Rounding of the height above a triangle's plane, times the length of its normal, in single precision. There are
/// about sixty roundings of 2^-24, and edges are at most two extents long. Local: an error bound of this arithmetic.
constexpr float kHeightRounding = 0x1p-17F * (2.0F * kExtent) * (2.0F * kExtent);

/// Rounding of twice a projected area, in squares of the largest coordinate: about thirty roundings of 2^-24. Local: an
/// error bound of this arithmetic.
constexpr float kAreaRounding = 0x1p-18F;

/// Length below which directions count as zero, because their reciprocal would leave the range of doubles. Local: a
/// guard against the end of the range of doubles.
constexpr double kShortestDirection = 1e-290;

/// Relative rounding of a fraction of a path, which is a quotient of heights in single precision. Local: an error bound
/// of this arithmetic.
constexpr float kFractionRounding = 0x1p-20F;

/// Largest reciprocal length, in 1/m, of a segment that is clipped to a cluster. The squared length of a shorter
/// segment would leave the range of doubles. Local: a guard against the end of the range of doubles.
constexpr double kMaxPerLength = 1e140;

// Vectors of four numbers (vector extensions of GCC and Clang). They fill one register of every 64-bit processor.
using Quad = float __attribute__((vector_size(16)));
using Mask = int __attribute__((vector_size(16)));

struct QuadVec {
    Quad x;
    Quad y;
    Quad z;
};

// Converts four numbers to single precision. The sign extension by an arithmetic shift takes three instructions on all
// 64-bit processors.
Quad loaded(const TriangleCluster::Lanes& lanes) {
    using Numbers = std::int16_t __attribute__((vector_size(16)));
    const auto numbers = std::bit_cast<Numbers>(std::array{std::bit_cast<std::uint64_t>(lanes), std::uint64_t{0}});
    const Numbers doubled = __builtin_shufflevector(numbers, numbers, 0, 0, 1, 1, 2, 2, 3, 3);
    return __builtin_convertvector(std::bit_cast<Mask>(doubled) >> 16, Quad);
}

QuadVec operator-(const QuadVec& a, const QuadVec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

QuadVec cross(const QuadVec& a, const QuadVec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Quad dot(const QuadVec& a, const QuadVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Quad dot(const QuadVec& a, const std::array<float, 3>& b) { return a.x * b[0] + a.y * b[1] + a.z * b[2]; }

Quad abs(const Quad& a) { return std::bit_cast<Quad>(std::bit_cast<Mask>(a) & 0x7FFFFFFF); }

Quad min(const Quad& a, const Quad& b) { return a < b ? a : b; }

Quad max(const Quad& a, const Quad& b) { return a > b ? a : b; }

/// Returns |x| + |y| + |z|, which is at least the length and at most sqrt(3) times the length.
Quad size_of(const QuadVec& a) { return abs(a.x) + abs(a.y) + abs(a.z); }

/// The chord of the part of a path that passes a cluster, in the cluster's units.
struct LocalSegment {
    double begin;  ///< fractions of the whole path
    double end;
    Vec3 start;  ///< from the centre
    Vec3 chord;
    double width;               ///< the margin
    std::array<float, 3> from;  ///< start, chord and width in single precision
    std::array<float, 3> along;
    float margin;
    float size;  ///< upper bound on all numbers here and on differences to the corners
};

/// Factor for the remaining rounding of the margin, which is far below the rounding of the bounds. Local: an error
/// bound of this arithmetic.
constexpr double kMarginRounding = 1.0 + 0x1p-20;

/// Returns the part of a path that can be within the margin of a triangle. All its points are within twice the extent
/// plus the margin from the cluster's centre. The part is empty (begin > end) if no point is that near. The sagitta of
/// the part is the path's sagitta times the square of the part's share of the path.
LocalSegment localized(const TriangleCluster& cluster, const Tube& tube) {
    LocalSegment local{0.0, 1.0, {}, {}, 0.0, {}, {}, 0.0F, 0.0F};
    const Vec3 offset = cluster.center - tube.from;
    if (tube.per_length < kMaxPerLength) {
        const double middle = dot(offset, tube.along) * tube.per_length * tube.per_length;
        const double margin = (tube.margin + tube.sagitta) * kMarginRounding;
        const double half = (2.0 * kExtent / cluster.per_unit + margin) * tube.per_length;
        local.begin = std::max(0.0, middle - half);
        local.end = std::min(1.0, middle + half);
    }
    const double share = local.end - local.begin;
    const Vec3 begin = tube.offset(local.begin);
    const Vec3 from = local.start = cluster.per_unit * (begin - offset);
    const Vec3 along = local.chord = cluster.per_unit * (tube.offset(local.end) - begin);
    const double margin = tube.margin + share * share * tube.sagitta;
    local.width = kCornerRounding + cluster.per_unit * margin * kMarginRounding;
    local.margin = static_cast<float>(local.width);
    local.from = {static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)};
    local.along = {static_cast<float>(along.x), static_cast<float>(along.y), static_cast<float>(along.z)};
    local.size = 2.0F * kExtent + static_cast<float>(max_abs(from) + max_abs(along));
    return local;
}

/// The axes of the projection by a shear along kAxis.
template <int kAxis>
struct Projection {
    static constexpr int kRight = (kAxis + 1) % 3;
    static constexpr int kUp = (kAxis + 2) % 3;
};

/// A path projected along its own direction to a point, relative to a cluster's centre and in the cluster's units.
struct View {
    float right;  ///< of the shear
    float up;
    float x;  ///< to the right
    float y;  ///< up
    float margin;
    float size;  ///< upper bound on all numbers here and on differences to the corners
};

/// Projects a path along the shear to a point. point: a point of the path, relative to the cluster's centre. extent:
/// bound on the path's extent beyond this point; 0 for a path that is not clipped to the cluster.
template <int kAxis>
View view_along(const Vec3& point, const Shear& shear, double margin, float extent) {
    using Axes = Projection<kAxis>;
    View view{static_cast<float>(shear.right),
              static_cast<float>(shear.up),
              static_cast<float>(point[Axes::kRight] - shear.right * point[kAxis]),
              static_cast<float>(point[Axes::kUp] - shear.up * point[kAxis]),
              static_cast<float>(margin * (shear.norm * kMarginRounding)),
              0.0F};
    view.size = 4.0F * kExtent + view.margin + std::fabs(view.x) + std::fabs(view.y) + extent;
    return view;
}

bool is_empty(const Mask& mask) {
    const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(mask);
    return (halves[0] | halves[1]) == 0;
}

struct QuadPoint {
    Quad x;
    Quad y;
};

/// Twice the signed area of the triangle of the origin and an edge, and a bound. If the area differs from 0 by more
/// than the bound, the origin is certainly more than the margin on one side of the edge.
struct EdgeSide {
    Quad area;
    Quad bound;
};

EdgeSide side_of_edge(const QuadPoint& from, const QuadPoint& to, const View& view, float rounding) {
    const Quad length = abs(to.x - from.x) + abs(to.y - from.y);
    return {from.x * to.y - from.y * to.x, view.margin * length + rounding};
}

template <int kAxis>
const std::array<TriangleCluster::Lanes, 3>& coordinates(const TriangleCluster& cluster) {
    return kAxis == 0 ? cluster.x : (kAxis == 1 ? cluster.y : cluster.z);
}

// The projected triangle misses the path's point if the point is certainly beyond one of its edges or outside its box.
// The test does not depend on the winding. The three signed areas add up to the area of the triangle. For a point
// beyond an edge, one of them therefore has a sign that the other two do not have. For a triangle that projects to a
// line, the box decides.
template <int kAxis>
Mask lanes_of(const TriangleCluster& cluster, const View& view) {
    using Axes = Projection<kAxis>;
    std::array<QuadPoint, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
        const Quad depth = loaded(coordinates<kAxis>(cluster)[k]);
        corner[k].x = loaded(coordinates<Axes::kRight>(cluster)[k]) - view.right * depth - view.x;
        corner[k].y = loaded(coordinates<Axes::kUp>(cluster)[k]) - view.up * depth - view.y;
    }
    const auto& [a, b, c] = corner;
    const float rounding = kAreaRounding * view.size * view.size;
    const EdgeSide ab = side_of_edge(a, b, view, rounding);
    const EdgeSide bc = side_of_edge(b, c, view, rounding);
    const EdgeSide ca = side_of_edge(c, a, view, rounding);
    const Quad none{};
    const Mask beyond = (min(min(ab.area + ab.bound, bc.area + bc.bound), ca.area + ca.bound) < none) &
                        (max(max(ab.area - ab.bound, bc.area - bc.bound), ca.area - ca.bound) > none);
    const float near = view.margin + kAreaRounding * view.size;
    const Mask outside_box = (min(min(a.x, b.x), c.x) > near) | (max(max(a.x, b.x), c.x) < -near) |
                             (min(min(a.y, b.y), c.y) > near) | (max(max(a.y, b.y), c.y) < -near);
    return ~(beyond | outside_box);
}

/// Returns the lanes that may be near a path along the shear. Straight paths need not be clipped to the cluster first,
/// because the whole line projects to one point.
Mask projected_lanes(const TriangleCluster& cluster, const Vec3& point, const Shear& shear, double margin,
                     float extent) {
    switch (shear.axis) {
        case 0:
            return lanes_of<0>(cluster, view_along<0>(point, shear, margin, extent));
        case 1:
            return lanes_of<1>(cluster, view_along<1>(point, shear, margin, extent));
        default:
            return lanes_of<2>(cluster, view_along<2>(point, shear, margin, extent));
    }
}

// The tube can touch a triangle only while the chord is within the margin of the triangle's plane. All comparisons
// avoid division by the normal's length, so slivers only make the bound larger.
unsigned overlapping_lanes(const TriangleCluster& cluster, const LocalSegment& segment, const Mask& projected,
                           TubeIntervals& intervals) {
    const QuadVec a{loaded(cluster.x[0]), loaded(cluster.y[0]), loaded(cluster.z[0])};
    const QuadVec ab = QuadVec{loaded(cluster.x[1]), loaded(cluster.y[1]), loaded(cluster.z[1])} - a;
    const QuadVec ac = QuadVec{loaded(cluster.x[2]), loaded(cluster.y[2]), loaded(cluster.z[2])} - a;
    const QuadVec normal = cross(ab, ac);
    const float rounding = kHeightRounding * segment.size;
    const Quad bound = segment.margin * size_of(normal) + rounding;
    const QuadVec start{segment.from[0] - a.x, segment.from[1] - a.y, segment.from[2] - a.z};
    const Quad height = dot(normal, start);
    const Quad slope = dot(normal, segment.along);
    const Quad per_slope = 1.0F / slope;
    const Quad first = (-bound - height) * per_slope;
    const Quad second = (bound - height) * per_slope;
    const Quad none{};
    const Quad lower = min(first, second);
    const Quad upper = max(first, second);
    // If the slope is zero within rounding, no interval can be computed.
    const Mask is_level = abs(slope) <= rounding;
    const Quad enter = is_level ? none : max(lower - kFractionRounding * abs(lower), none);
    const Quad leave = is_level ? none + 1.0F : min(upper + kFractionRounding * abs(upper), none + 1.0F);
    const Mask near = projected & (is_level ? abs(height) <= bound + 2.0F * rounding : enter <= leave);
    const double span = segment.end - segment.begin;
    unsigned bits = 0;
    for (unsigned lane = 0; lane < 4; ++lane) {
        if (near[lane] == 0 || cluster.triangle[lane] == kNoTriangle) continue;
        bits |= 1U << lane;
        intervals.enter[lane] = segment.begin + static_cast<double>(enter[lane]) * span;
        intervals.leave[lane] = segment.begin + static_cast<double>(leave[lane]) * span;
    }
    return bits;
}

}  // namespace

Shear::Shear(const Vec3& direction) {
    const Vec3 size = abs(direction);
    axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    if (!(size[axis] > kShortestDirection)) return;
    right = direction[(axis + 1) % 3] / direction[axis];
    up = direction[(axis + 2) % 3] / direction[axis];
    norm = std::sqrt(1.0 + right * right + up * up);
}

unsigned TriangleCluster::overlaps(const Tube& tube, TubeIntervals& intervals) const {
    if (tube.is_straight) {
        const Vec3 start = per_unit * (tube.from - center);
        const Mask projected =
            projected_lanes(*this, start, tube.shear, kCornerRounding + per_unit * tube.margin, 0.0F);
        if (is_empty(projected)) return 0;
        const LocalSegment segment = localized(*this, tube);
        return segment.begin > segment.end ? 0 : overlapping_lanes(*this, segment, projected, intervals);
    }
    const LocalSegment segment = localized(*this, tube);
    if (segment.begin > segment.end) return 0;
    const Shear shear(segment.chord);
    const Mask projected = projected_lanes(*this, segment.start, shear, segment.width, segment.size);
    return is_empty(projected) ? 0 : overlapping_lanes(*this, segment, projected, intervals);
}

Box3 TriangleCluster::box() const {
    const double unit = 1.0 / per_unit;
    Box3 result;
    for (std::size_t lane = 0; lane < 4; ++lane) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 corner{static_cast<double>(x[k][lane]), static_cast<double>(y[k][lane]),
                              static_cast<double>(z[k][lane])};
            result.include(center + unit * corner);
        }
    }
    const double rounding = kCornerRounding * unit;
    const Vec3 by{rounding, rounding, rounding};
    return {result.lower - by, result.upper + by};
}

}  // namespace ricochet
