// Builds clusters of neighbouring triangles for a mesh.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "ricochet/core/box3.h"
#include "ricochet/core/parallel.h"
#include "ricochet/geometry/acceleration/triangle_clusters.h"

namespace ricochet {
namespace {

constexpr std::size_t kBlock = 1 << 12;

/// Fixed cost of a cluster in memory and time, in units of the mean surface of a triangle's box. The surface of the
/// cluster's own box is added to it. Neighbours along the Morton curve need not be neighbours in space, so full
/// clusters are not always optimal. Local, because only the cost depends on it.
constexpr double kCostOfCluster = 2.0;

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
    const auto bits = static_cast<unsigned>(std::bit_width(triangles.size()));
    std::vector<std::uint64_t> keys(triangles.size());
    parallel_for_blocks(keys.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const Vec3 center = box_of(vertices, triangles[t]).center();
            keys[t] = morton_key(center, box, static_cast<std::uint32_t>(t), bits);
        }
    });
    parallel_sort(keys);
    std::vector<std::uint32_t> order(keys.size());
    std::transform(keys.begin(), keys.end(), order.begin(), [&](std::uint64_t key) { return index_of_key(key, bits); });
    return order;
}

/// Returns the length of a triangle's longest edge, in m, rounded up. It is infinite beyond the range of floats.
float longest_edge(std::span<const Vec3> vertices, const Triangle& triangle) {
    const auto& [a, b, c] = triangle;
    const double longest = std::max(
        {length(vertices[b] - vertices[a]), length(vertices[c] - vertices[b]), length(vertices[a] - vertices[c])});
    const double rounded = std::min(longest * (1.0 + 0x1p-40), double{std::numeric_limits<float>::max()});
    return std::nextafterf(static_cast<float>(rounded), std::numeric_limits<float>::infinity());
}

TriangleCluster cluster_of(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                           std::span<const std::uint32_t> members) {
    TriangleCluster cluster;
    for (std::size_t lane = 0; lane < 4; ++lane) {
        const bool is_used = lane < members.size();
        const std::uint32_t triangle = members[is_used ? lane : 0];
        cluster.triangle[lane] = is_used ? triangle : kNoTriangle;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& corner = vertices[triangles[triangle][k]];
            cluster.corners[k][0][lane] = corner.x;
            cluster.corners[k][1][lane] = corner.y;
            cluster.corners[k][2][lane] = corner.z;
        }
        cluster.edge[lane] = longest_edge(vertices, triangles[triangle]);
    }
    return cluster;
}

/// Returns half the surface of a box, in m^2. The share of random lines that intersect the box is proportional to its
/// surface.
double half_area(const Box3& box) {
    const Vec3 size = box.size();
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// Divides consecutive triangles into clusters so that the sum of the clusters' costs is minimal. Returns the ends of
/// the clusters. boxes: of the triangles, in order. Method: dynamic programming over the size of the last cluster.
std::vector<std::uint32_t> cluster_ends(const std::vector<Box3>& boxes) {
    double area = 0.0;
    for (const Box3& box : boxes) area += half_area(box);
    const double each = kCostOfCluster * area / static_cast<double>(boxes.size());
    std::vector<double> least(boxes.size() + 1, 0.0);
    std::vector<std::uint32_t> members(boxes.size() + 1, 1);
    for (std::uint32_t end = 1; end <= boxes.size(); ++end) {
        least[end] = std::numeric_limits<double>::infinity();
        Box3 box;
        for (std::uint32_t count = 1; count <= std::min(4U, end); ++count) {
            box.include(boxes[end - count]);
            const double cost = least[end - count] + half_area(box) + each;
            if (cost > least[end]) continue;
            least[end] = cost;
            members[end] = count;
        }
    }
    std::vector<std::uint32_t> ends;
    for (auto end = static_cast<std::uint32_t>(boxes.size()); end > 0; end -= members[end]) ends.push_back(end);
    std::reverse(ends.begin(), ends.end());
    return ends;
}

/// A block of triangles in spatial order, and the ends of its clusters.
struct Block {
    std::span<const std::uint32_t> triangles;
    std::vector<std::uint32_t> ends;
    std::size_t first = 0;  ///< index of the block's first cluster
};

std::vector<Block> divide(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                          std::span<const std::uint32_t> order) {
    std::vector<Block> blocks((order.size() + kBlock - 1) / kBlock);
    parallel_for_blocks(order.size(), kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        const auto members = order.subspan(begin, end - begin);
        std::vector<Box3> boxes;
        boxes.reserve(members.size());
        for (const std::uint32_t triangle : members) boxes.push_back(box_of(vertices, triangles[triangle]));
        blocks[block] = {members, cluster_ends(boxes)};
    });
    for (std::size_t k = 1; k < blocks.size(); ++k) {
        blocks[k].first = blocks[k - 1].first + blocks[k - 1].ends.size();
    }
    return blocks;
}

}  // namespace

TriangleClusters make_clusters(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    const std::vector<std::uint32_t> order = in_spatial_order(vertices, triangles);
    const std::vector<Block> blocks = divide(vertices, triangles, order);
    if (blocks.empty()) return {};
    TriangleClusters clusters(blocks.back().first + blocks.back().ends.size());
    parallel_for_blocks(blocks.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
        const auto& [members, ends, first] = blocks[k];
        std::size_t begin = 0;
        for (std::size_t c = 0; c < ends.size(); ++c) {
            clusters[first + c] = cluster_of(vertices, triangles, members.subspan(begin, ends[c] - begin));
            begin = ends[c];
        }
    });
    return clusters;
}

TriangleClusters refitted(std::span<const TriangleCluster> clusters, std::span<const Vec3> vertices,
                          std::span<const Triangle> triangles) {
    TriangleClusters moved(clusters.size());
    parallel_for_blocks(clusters.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const auto& lanes = clusters[k].triangle;
            const auto count =
                static_cast<std::size_t>(std::find(lanes.begin(), lanes.end(), kNoTriangle) - lanes.begin());
            moved[k] = cluster_of(vertices, triangles, std::span(lanes).first(count));
        }
    });
    return moved;
}

}  // namespace ricochet
