#include "ricochet/geometry/triangle_clusters.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ricochet/core/morton.h"
#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

constexpr std::size_t kBlock = 1 << 12;

/// Of the height of a point above a triangle's plane times the size of its normal, in single precision, for corners and
/// points of size 1: some sixty roundings of 2^-24, times the edges' sizes.
constexpr float kRounding = 0x1p-18F;

/// Of the direction of an edge, whose ends are rounded to 2^-25.
constexpr float kEdgeRounding = 0x1p-21F;

/// Of a fraction that is a quotient of such numbers.
constexpr float kFractionRounding = 0x1p-20F;

/// How much longer than its largest triangle's box a cluster's may be: next to each other along the curve need not be
/// next to each other in space.
constexpr double kLongestBox = 2.0;

// Four numbers at once (GCC's and Clang's vector extensions): one register of every 64-bit processor.
using Quad = float __attribute__((vector_size(16)));
using Mask = int __attribute__((vector_size(16)));

struct QuadVec {
    Quad x;
    Quad y;
    Quad z;
};

Quad loaded(const TriangleCluster::Lanes& lanes) {
    Quad quad;
    std::memcpy(&quad, lanes.data(), sizeof(quad));
    return quad;
}

QuadVec operator-(const QuadVec& a, const QuadVec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

QuadVec cross(const QuadVec& a, const QuadVec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Quad dot(const QuadVec& a, const QuadVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Quad abs(const Quad& a) { return a < 0.0F ? -a : a; }

Quad min(const Quad& a, const Quad& b) { return a < b ? a : b; }

Quad max(const Quad& a, const Quad& b) { return a > b ? a : b; }

/// |x| + |y| + |z|, at least the length and at most sqrt(3) of it.
Quad size_of(const QuadVec& a) { return abs(a.x) + abs(a.y) + abs(a.z); }

/// The part of a segment that passes by a cluster, in the cluster's units.
struct LocalSegment {
    double begin;  ///< fractions of the whole segment
    double end;
    std::array<float, 3> from;
    std::array<float, 3> along;
    float margin;
    float reach;  ///< at least the size of all numbers here and of differences to the corners

    [[nodiscard]] QuadVec at(const QuadVec& start, const Quad& fraction) const {
        return {start.x + fraction * along[0], start.y + fraction * along[1], start.z + fraction * along[2]};
    }
};

/// Only what is within a size and the margin of the centre can be within the margin of a triangle. The part is empty
/// (begin > end) when nothing is.
LocalSegment localized(const TriangleCluster& cluster, const SegmentTube& tube) {
    const double margin = tube.margin * (1.0 + 0x1p-20);  // what else rounding does here is far below the bounds' own
    LocalSegment local{0.0, 1.0, {}, {}, static_cast<float>(margin / cluster.size), 0.0F};
    if (tube.length > 0.0) {
        const double middle = dot(cluster.center - tube.from, tube.along) / (tube.length * tube.length);
        const double half = (cluster.size + margin) / tube.length;
        local.begin = std::max(0.0, middle - half);
        local.end = std::min(1.0, middle + half);
    }
    const double scale = 1.0 / cluster.size;
    const Vec3 from = scale * (tube.from + local.begin * tube.along - cluster.center);
    const Vec3 along = (scale * (local.end - local.begin)) * tube.along;
    local.from = {static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)};
    local.along = {static_cast<float>(along.x), static_cast<float>(along.y), static_cast<float>(along.z)};
    local.reach = static_cast<float>(1.0 + max_abs(from) + max_abs(along));
    return local;
}

/// All bits where both points are further than the bound beyond the edge that leaves the corner.
Mask beyond_edge(const QuadVec& corner, const QuadVec& edge, const QuadVec& normal, const Quad& bound,
                 const Quad& rounding, const QuadVec& p, const QuadVec& q) {
    const QuadVec outward = cross(edge, normal);
    const Quad nearest = min(dot(outward, p - corner), dot(outward, q - corner));
    return nearest > size_of(edge) * bound + rounding;
}

// The tube can touch a triangle only while its segment is within the margin of the triangle's plane. It does not when
// over all of that stretch the segment stays beyond one edge: heights over the edge are linear, so both ends of the
// stretch tell. Everything is compared without dividing by the normal's length, so slivers only make the bound larger.
// A NaN, from a segment in the plane, counts as near.
unsigned near_lanes(const TriangleCluster& cluster, const LocalSegment& segment, TubeStretches& stretches) {
    const QuadVec a{loaded(cluster.x[0]), loaded(cluster.y[0]), loaded(cluster.z[0])};
    const QuadVec b{loaded(cluster.x[1]), loaded(cluster.y[1]), loaded(cluster.z[1])};
    const QuadVec c{loaded(cluster.x[2]), loaded(cluster.y[2]), loaded(cluster.z[2])};
    const QuadVec ab = b - a;
    const QuadVec ac = c - a;
    const QuadVec normal = cross(ab, ac);
    const Quad size = size_of(normal);
    const Quad rounding = (kRounding * segment.reach) * (size_of(ab) + size_of(ac));
    const Quad bound = segment.margin * size + rounding;
    const QuadVec start{segment.from[0] - a.x, segment.from[1] - a.y, segment.from[2] - a.z};
    const Quad height = dot(normal, start);
    const Quad slope = normal.x * segment.along[0] + normal.y * segment.along[1] + normal.z * segment.along[2];
    const Quad first = (-bound - height) / slope;
    const Quad second = (bound - height) / slope;
    const Quad none{};
    const Quad lower = min(first, second);
    const Quad upper = max(first, second);
    Quad enter = lower > 0.0F ? lower - kFractionRounding * lower : none;
    Quad leave = upper < 1.0F ? upper + kFractionRounding * abs(upper) : none + 1.0F;
    // A slope that is rounding says nothing about where.
    const Mask is_level = abs(slope) <= rounding;
    enter = is_level ? none : enter;
    leave = is_level ? none + 1.0F : leave;
    Mask near = is_level ? abs(height) <= bound + abs(slope) + rounding : ~(enter > leave);
    if ((near[0] | near[1] | near[2] | near[3]) == 0) return 0;
    const QuadVec p = segment.at(start, enter);
    const QuadVec q = segment.at(start, leave);
    const Quad of_edges = (kEdgeRounding * segment.reach) * size;
    near &= ~beyond_edge({none, none, none}, ab, normal, bound, of_edges, p, q);
    near &= ~beyond_edge(ab, c - b, normal, bound, of_edges, p, q);
    near &= ~beyond_edge(ac, a - c, normal, bound, of_edges, p, q);
    const double span = segment.end - segment.begin;
    unsigned bits = 0;
    for (unsigned lane = 0; lane < 4; ++lane) {
        if (near[lane] == 0 || cluster.triangle[lane] == kNoTriangle) continue;
        bits |= 1U << lane;
        stretches.enter[lane] = segment.begin + static_cast<double>(enter[lane]) * span;
        stretches.leave[lane] = segment.begin + static_cast<double>(leave[lane]) * span;
    }
    return bits;
}

Box3 box_of(std::span<const Vec3> vertices, const Triangle& triangle) {
    Box3 box;
    for (const std::uint32_t v : triangle) box.include(vertices[v]);
    return box;
}

std::vector<std::uint32_t> in_spatial_order(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    Box3 box;
    for (const Triangle& t : triangles) {
        for (const std::uint32_t v : t) box.include(vertices[v]);
    }
    std::vector<std::uint64_t> keys(triangles.size());
    parallel_for_blocks(keys.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const Vec3 center = box_of(vertices, triangles[t]).center();
            keys[t] = std::uint64_t{morton_code(center, box)} << 32U | t;
        }
    });
    parallel_sort(keys);
    std::vector<std::uint32_t> order(keys.size());
    std::transform(keys.begin(), keys.end(), order.begin(), [](std::uint64_t key) { return static_cast<std::uint32_t>(key); });
    return order;
}

TriangleCluster cluster_of(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                           std::span<const std::uint32_t> members) {
    Box3 box;
    for (const std::uint32_t triangle : members) box.include(box_of(vertices, triangles[triangle]));
    TriangleCluster cluster;
    cluster.center = box.center();
    const double extent = max_abs(box.size());
    if (extent > 0.0) cluster.size = std::ldexp(1.0, std::ilogb(extent) + 1);
    for (std::size_t lane = 0; lane < 4; ++lane) {
        const bool is_there = lane < members.size();
        const std::uint32_t triangle = members[is_there ? lane : 0];
        cluster.triangle[lane] = is_there ? triangle : kNoTriangle;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 corner = (vertices[triangles[triangle][k]] - cluster.center) / cluster.size;
            cluster.x[k][lane] = static_cast<float>(corner.x);
            cluster.y[k][lane] = static_cast<float>(corner.y);
            cluster.z[k][lane] = static_cast<float>(corner.z);
        }
    }
    return cluster;
}

/// Where clusters end along the order.
std::vector<std::uint32_t> cluster_ends(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                        std::span<const std::uint32_t> order) {
    std::vector<std::uint32_t> ends;
    Box3 together;
    double longest = 0.0;
    std::uint32_t begin = 0;
    for (std::uint32_t k = 0; k < order.size(); ++k) {
        const Box3 box = box_of(vertices, triangles[order[k]]);
        Box3 joined = together;
        joined.include(box);
        longest = std::max(longest, box.diagonal());
        if (k > begin && (k - begin == 4 || joined.diagonal() > kLongestBox * longest)) {
            ends.push_back(k);
            begin = k;
            joined = box;
            longest = box.diagonal();
        }
        together = joined;
    }
    if (!order.empty()) ends.push_back(static_cast<std::uint32_t>(order.size()));
    return ends;
}

}  // namespace

unsigned TriangleCluster::near(const SegmentTube& tube, TubeStretches& stretches) const {
    const LocalSegment segment = localized(*this, tube);
    return segment.begin > segment.end ? 0 : near_lanes(*this, segment, stretches);
}

Box3 TriangleCluster::box() const {
    Box3 result;
    for (std::size_t lane = 0; lane < 4; ++lane) {
        for (std::size_t k = 0; k < 3; ++k) result.include(center + size * Vec3{x[k][lane], y[k][lane], z[k][lane]});
    }
    const double rounding = 0x1p-23 * size;
    const Vec3 by{rounding, rounding, rounding};
    return {result.lower - by, result.upper + by};
}

std::vector<TriangleCluster> make_clusters(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    const std::vector<std::uint32_t> order = in_spatial_order(vertices, triangles);
    const std::vector<std::uint32_t> ends = cluster_ends(vertices, triangles, order);
    std::vector<TriangleCluster> clusters(ends.size());
    parallel_for_blocks(ends.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            const std::size_t first = c == 0 ? 0 : ends[c - 1];
            clusters[c] = cluster_of(vertices, triangles, std::span(order).subspan(first, ends[c] - first));
        }
    });
    return clusters;
}

}  // namespace ricochet
