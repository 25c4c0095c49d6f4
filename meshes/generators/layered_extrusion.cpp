#include "generators/layered_extrusion.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace ricochet::meshes {
namespace {

constexpr std::uint32_t kUnset = std::numeric_limits<std::uint32_t>::max();
constexpr int kNothing = -1;

/// Edge of the region, with the parts of the triangles on its two sides.
struct PlanarEdge {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    int left = kNothing;
    int right = kNothing;
};

std::vector<PlanarEdge> one_sided_edges(const PlanarRegion& region) {
    std::vector<PlanarEdge> edges;
    edges.reserve(3 * region.triangles.size());
    for (std::size_t t = 0; t < region.triangles.size(); ++t) {
        const Triangle& triangle = region.triangles[t];
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t from = triangle[corner];
            const std::uint32_t to = triangle[(corner + 1) % 3];
            const int part = region.parts[t];
            edges.push_back(from < to ? PlanarEdge{from, to, part, kNothing} : PlanarEdge{to, from, kNothing, part});
        }
    }
    return edges;
}

/// Returns the edges that can have a wall, because the parts on their two sides differ, in a fixed order.
std::vector<PlanarEdge> border_edges(const PlanarRegion& region) {
    std::vector<PlanarEdge> edges = one_sided_edges(region);
    std::sort(edges.begin(), edges.end(), [](const PlanarEdge& a, const PlanarEdge& b) {
        return a.from != b.from ? a.from < b.from : a.to < b.to;
    });
    std::vector<PlanarEdge> borders;
    for (std::size_t i = 0; i < edges.size();) {
        PlanarEdge edge = edges[i++];
        for (; i < edges.size() && edges[i].from == edge.from && edges[i].to == edge.to; ++i) {
            edge.left = std::max(edge.left, edges[i].left);
            edge.right = std::max(edge.right, edges[i].right);
        }
        if (edge.left != edge.right) borders.push_back(edge);
    }
    return borders;
}

bool contains(std::uint32_t parts, int part) { return part != kNothing && ((parts >> part) & 1U) != 0; }

class Extruder {
public:
    Extruder(const PlanarRegion& region, std::span<const Slab> slabs)
        : region_(region),
          slabs_(slabs),
          borders_(border_edges(region)),
          base_(region.points.size(), kUnset),
          top_(region.points.size(), kUnset) {}

    TriangleMesh run() {
        cap(0, slabs_.front().parts);
        for (std::size_t s = 0; s < slabs_.size(); ++s) {
            const std::uint32_t above = s + 1 < slabs_.size() ? slabs_[s + 1].parts : 0;
            walls(slabs_[s]);
            base_.swap(top_);
            std::fill(top_.begin(), top_.end(), kUnset);
            base_height_ += slabs_[s].thickness;
            cap(slabs_[s].parts, above);
        }
        return std::move(mesh_);
    }

private:
    /// Returns the vertex above a point of the region, on the slab border whose table is given.
    std::uint32_t vertex(std::vector<std::uint32_t>& table, std::uint32_t point, double height) {
        if (table[point] == kUnset) table[point] = add_vertex(point, height);
        return table[point];
    }

    std::uint32_t add_vertex(std::uint32_t point, double height) {
        mesh_.vertices.push_back({region_.points[point].x, region_.points[point].y, height});
        return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
    }

    /// Adds the triangles at base_height_ that are solid on only one side.
    void cap(std::uint32_t below, std::uint32_t above) {
        for (std::size_t t = 0; t < region_.triangles.size(); ++t) {
            const bool solid_below = contains(below, region_.parts[t]);
            if (solid_below == contains(above, region_.parts[t])) continue;
            Triangle corners = region_.triangles[t];
            if (!solid_below) std::swap(corners[1], corners[2]);
            for (std::uint32_t& corner : corners) corner = vertex(base_, corner, base_height_);
            mesh_.triangles.push_back(corners);
        }
    }

    void walls(const Slab& slab) {
        std::vector<std::array<std::uint32_t, 2>> edges;  // solid on the left
        for (const PlanarEdge& edge : borders_) {
            const bool left = contains(slab.parts, edge.left);
            if (left == contains(slab.parts, edge.right)) continue;
            edges.push_back(left ? std::array{edge.from, edge.to} : std::array{edge.to, edge.from});
        }
        std::vector<std::uint32_t> lower = border_row(edges, base_, base_height_);
        for (int layer = 1; layer <= slab.layers; ++layer) {
            std::vector<std::uint32_t> upper =
                layer == slab.layers ? border_row(edges, top_, base_height_ + slab.thickness)
                                     : inner_row(edges, base_height_ + slab.thickness * layer / slab.layers);
            add_strip(lower, upper);
            lower.swap(upper);
        }
    }

    /// Returns the vertices of the edges' ends (two per edge) on a slab border, shared with the caps.
    std::vector<std::uint32_t> border_row(const std::vector<std::array<std::uint32_t, 2>>& edges,
                                          std::vector<std::uint32_t>& table, double height) {
        std::vector<std::uint32_t> row;
        row.reserve(2 * edges.size());
        for (const auto& edge : edges) {
            for (const std::uint32_t point : edge) row.push_back(vertex(table, point, height));
        }
        return row;
    }

    /// Returns the vertices of the edges' ends inside a slab.
    std::vector<std::uint32_t> inner_row(const std::vector<std::array<std::uint32_t, 2>>& edges, double height) {
        if (scratch_.empty()) scratch_.assign(region_.points.size(), kUnset);
        std::vector<std::uint32_t> row = border_row(edges, scratch_, height);
        for (const auto& edge : edges) scratch_[edge[0]] = scratch_[edge[1]] = kUnset;
        return row;
    }

    void add_strip(const std::vector<std::uint32_t>& lower, const std::vector<std::uint32_t>& upper) {
        for (std::size_t i = 0; i < lower.size(); i += 2) {
            mesh_.triangles.push_back({lower[i], lower[i + 1], upper[i + 1]});
            mesh_.triangles.push_back({lower[i], upper[i + 1], upper[i]});
        }
    }

    const PlanarRegion& region_;
    std::span<const Slab> slabs_;
    std::vector<PlanarEdge> borders_;
    std::vector<std::uint32_t> base_;     // vertex of every point on the slab border below, if it exists
    std::vector<std::uint32_t> top_;      // likewise on the border above
    std::vector<std::uint32_t> scratch_;  // likewise inside a slab
    double base_height_ = 0.0;
    TriangleMesh mesh_;
};

}  // namespace

TriangleMesh layered_extrusion(const PlanarRegion& region, std::span<const Slab> slabs) {
    return Extruder(region, slabs).run();
}

TriangleMesh extrusion(const PlanarRegion& region, double thickness, double edge_length) {
    const Slab slab{thickness, 1, steps_in(thickness, edge_length)};
    return layered_extrusion(region, {&slab, 1});
}

}  // namespace ricochet::meshes
