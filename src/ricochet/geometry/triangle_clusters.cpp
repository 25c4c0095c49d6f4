#include "ricochet/geometry/triangle_clusters.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/morton.h"
#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

constexpr std::size_t kBlock = 1 << 12;

/// Of a triple product with coordinates below 1: some twenty roundings of 2^-53 and the size 4 of differences.
constexpr double kRounding = 0x1p-46;

/// How much longer than its largest triangle's box a cluster's may be: next to each other along the curve need not be
/// next to each other in space.
constexpr double kLongestBox = 2.0;

// Four numbers at once, in whatever registers the processor has (GCC's and Clang's vector extensions).
using Quad = double __attribute__((vector_size(32)));
using Mask = long long __attribute__((vector_size(32)));

struct QuadVec {
    Quad x;
    Quad y;
    Quad z;
};

#define RICOCHET_INLINE [[gnu::always_inline]] inline

RICOCHET_INLINE void load(const TriangleCluster::Lanes& lanes, Quad& quad) {
    __builtin_memcpy(&quad, lanes.data(), sizeof(quad));
}

RICOCHET_INLINE void subtract(const QuadVec& a, const QuadVec& b, QuadVec& result) {
    result.x = a.x - b.x;
    result.y = a.y - b.y;
    result.z = a.z - b.z;
}

RICOCHET_INLINE void take_cross(const QuadVec& a, const QuadVec& b, QuadVec& result) {
    result.x = a.y * b.z - a.z * b.y;
    result.y = a.z * b.x - a.x * b.z;
    result.z = a.x * b.y - a.y * b.x;
}

RICOCHET_INLINE void take_dot(const QuadVec& a, const QuadVec& b, Quad& result) {
    result = a.x * b.x + a.y * b.y + a.z * b.z;
}

RICOCHET_INLINE void take_abs(const Quad& a, Quad& result) { result = a < 0.0 ? -a : a; }

/// |x| + |y| + |z|, at least the length and at most sqrt(3) of it.
RICOCHET_INLINE void take_size(const QuadVec& a, Quad& result) {
    Quad x;
    Quad y;
    Quad z;
    take_abs(a.x, x);
    take_abs(a.y, y);
    take_abs(a.z, z);
    result = x + y + z;
}

RICOCHET_INLINE void at_fraction(const QuadVec& from, const Vec3& along, const Quad& fraction, QuadVec& result) {
    result.x = from.x + fraction * along.x;
    result.y = from.y + fraction * along.y;
    result.z = from.z + fraction * along.z;
}

/// All bits where both points are further than the bound beyond the edge that leaves the corner; offsets are from the
/// cluster's first corners.
RICOCHET_INLINE void beyond_edge(const QuadVec& corner, const QuadVec& edge, const QuadVec& normal, const Quad& bound,
                                 const QuadVec& p, const QuadVec& q, Mask& result) {
    QuadVec outward;
    take_cross(edge, normal, outward);
    QuadVec from_corner;
    Quad at_p;
    Quad at_q;
    subtract(p, corner, from_corner);
    take_dot(outward, from_corner, at_p);
    subtract(q, corner, from_corner);
    take_dot(outward, from_corner, at_q);
    const Quad nearest = at_p < at_q ? at_p : at_q;
    Quad edge_squared;
    take_dot(edge, edge, edge_squared);
    result = (nearest > 0.0) & (nearest * nearest > edge_squared * bound * bound);
}

// The tube can touch a triangle only while its segment is within the margin of the triangle's plane. It does not when
// over all of that stretch the segment stays beyond one edge: heights over the edge are linear, so both ends of the
// stretch tell. Everything is compared without dividing by the normal's length, so slivers only make the bound larger.
// A NaN, from a segment in the plane, counts as near.
RICOCHET_INLINE unsigned near_lanes(const TriangleCluster& cluster, const SegmentTube& tube, TubeStretches& stretches) {
    std::array<QuadVec, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
        load(cluster.x[k], corner[k].x);
        load(cluster.y[k], corner[k].y);
        load(cluster.z[k], corner[k].z);
    }
    QuadVec ab;
    QuadVec bc;
    QuadVec ca;
    QuadVec ac;
    subtract(corner[1], corner[0], ab);
    subtract(corner[2], corner[1], bc);
    subtract(corner[0], corner[2], ca);
    subtract(corner[2], corner[0], ac);
    QuadVec normal;
    take_cross(ab, ac, normal);
    Quad size;
    Quad size_ab;
    Quad size_ac;
    take_size(normal, size);
    take_size(ab, size_ab);
    take_size(ac, size_ac);
    const Quad bound = tube.margin * size + (kRounding * tube.largest) * (size_ab * size_ac);
    QuadVec start;
    start.x = tube.from.x - corner[0].x;
    start.y = tube.from.y - corner[0].y;
    start.z = tube.from.z - corner[0].z;
    Quad height;
    take_dot(normal, start, height);
    const Quad slope = normal.x * tube.along.x + normal.y * tube.along.y + normal.z * tube.along.z;
    const Quad first = (-bound - height) / slope;
    const Quad second = (bound - height) / slope;
    Quad enter = first < second ? first : second;
    Quad leave = first < second ? second : first;
    const Quad none{};
    enter = enter > 0.0 ? enter : none;
    leave = leave < 1.0 ? leave : none + 1.0;
    Mask near = ~(enter > leave);
    if ((near[0] | near[1] | near[2] | near[3]) == 0) return 0;
    QuadVec p;
    QuadVec q;
    at_fraction(start, tube.along, enter, p);
    at_fraction(start, tube.along, leave, q);
    Mask beyond;
    const QuadVec origin{none, none, none};
    beyond_edge(origin, ab, normal, bound, p, q, beyond);
    near &= ~beyond;
    beyond_edge(ab, bc, normal, bound, p, q, beyond);
    near &= ~beyond;
    beyond_edge(ac, ca, normal, bound, p, q, beyond);
    near &= ~beyond;
    __builtin_memcpy(stretches.enter.data(), &enter, sizeof(enter));
    __builtin_memcpy(stretches.leave.data(), &leave, sizeof(leave));
    unsigned bits = 0;
    for (unsigned lane = 0; lane < 4; ++lane) {
        if (near[lane] != 0 && cluster.triangle[lane] != kNoTriangle) bits |= 1U << lane;
    }
    return bits;
}

using NearLanes = unsigned (*)(const TriangleCluster&, const SegmentTube&, TubeStretches&);

unsigned near_lanes_plain(const TriangleCluster& cluster, const SegmentTube& tube, TubeStretches& stretches) {
    return near_lanes(cluster, tube, stretches);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] unsigned near_lanes_wide(const TriangleCluster& cluster, const SegmentTube& tube,
                                                 TubeStretches& stretches) {
    return near_lanes(cluster, tube, stretches);
}

NearLanes fastest() { return __builtin_cpu_supports("avx2") != 0 ? near_lanes_wide : near_lanes_plain; }
#else
NearLanes fastest() { return near_lanes_plain; }
#endif

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
    TriangleCluster cluster;
    for (std::size_t lane = 0; lane < 4; ++lane) {
        const bool is_there = lane < members.size();
        const std::uint32_t triangle = members[is_there ? lane : 0];
        cluster.triangle[lane] = is_there ? triangle : kNoTriangle;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& corner = vertices[triangles[triangle][k]];
            cluster.x[k][lane] = corner.x;
            cluster.y[k][lane] = corner.y;
            cluster.z[k][lane] = corner.z;
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
    static const NearLanes function = fastest();
    return function(*this, tube, stretches);
}

Box3 TriangleCluster::box() const {
    Box3 result;
    for (std::size_t lane = 0; lane < 4; ++lane) {
        for (std::size_t k = 0; k < 3; ++k) result.include({x[k][lane], y[k][lane], z[k][lane]});
    }
    return result;
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
