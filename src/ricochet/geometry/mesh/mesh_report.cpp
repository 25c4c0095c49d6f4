#include "ricochet/geometry/mesh/mesh_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string_view>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/parallel.h"
#include "ricochet/geometry/mesh/closed_surface.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// A balanced tree over boxes, in double precision: nothing is rounded, so nothing is missed.
class BoxTree {
public:
    explicit BoxTree(const std::vector<Box3>& boxes);

    /// Calls visit(number) for every box that has a point in common with the given one. May be called from several
    /// threads at once.
    template <typename Visit>
    void for_each_overlap(const Box3& box, Visit&& visit) const {
        std::array<std::uint32_t, kMaxLevels> stack;
        std::size_t size = 0;
        if (!nodes_.empty()) stack[size++] = 0;
        while (size > 0) {
            const Node& node = nodes_[stack[--size]];
            if (!boxes_overlap(node.box, box)) continue;
            if (node.first_child != 0) {
                stack[size++] = node.first_child;
                stack[size++] = node.first_child + 1;
                continue;
            }
            for (std::uint32_t i = node.begin; i < node.end; ++i) {
                if (boxes_overlap(boxes_[order_[i]], box)) visit(order_[i]);
            }
        }
    }

private:
    // Halves are equal, so 32-bit numbers of boxes make at most 32 levels, each of which leaves one node waiting.
    static constexpr std::size_t kMaxLevels = 64;

    struct Node {
        Box3 box;
        std::uint32_t begin = 0;  // leaf: order_[begin, end)
        std::uint32_t end = 0;
        std::uint32_t first_child = 0;  // the other one follows; 0 for a leaf
    };

    [[nodiscard]] static bool boxes_overlap(const Box3& a, const Box3& b) {
        return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
               a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
    }
    void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end);

    const std::vector<Box3>& boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

BoxTree::BoxTree(const std::vector<Box3>& boxes) : boxes_(boxes), order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (boxes.empty()) return;
    nodes_.emplace_back();
    split(0, 0, static_cast<std::uint32_t>(boxes.size()));
}

void BoxTree::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
    constexpr std::uint32_t kLeafSize = 4;
    Box3 box;
    for (std::uint32_t i = begin; i < end; ++i) box.include(boxes_[order_[i]]);
    nodes_[node].box = box;
    nodes_[node].begin = begin;
    nodes_[node].end = end;
    if (end - begin <= kLeafSize) return;
    const Vec3 size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(
        order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](std::uint32_t a, std::uint32_t b) {
            return boxes_[a].lower[axis] + boxes_[a].upper[axis] < boxes_[b].lower[axis] + boxes_[b].upper[axis];
        });
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[node].first_child = child;
    split(child, begin, middle);
    split(child + 1, middle, end);
}

// Two triangles turned so that the vertices that both name come first, in the same order.
struct TrianglePair {
    Triangle first;
    Triangle second;
    int shared = 0;
};

TrianglePair align(Triangle first, Triangle second) {
    TrianglePair pair{first, second, 0};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto at = std::find(pair.second.begin() + pair.shared, pair.second.end(), first[i]);
        if (at == pair.second.end()) continue;
        const auto next = static_cast<std::size_t>(pair.shared);
        std::iter_swap(at, pair.second.begin() + pair.shared);
        std::swap(pair.first[i], pair.first[next]);
        ++pair.shared;
    }
    return pair;
}

class PairTest {
public:
    explicit PairTest(const TriangleMesh& mesh) : mesh_(mesh) {}

    [[nodiscard]] bool operator()(std::uint32_t i, std::uint32_t j) const {
        const TrianglePair pair = align(mesh_.triangles[i], mesh_.triangles[j]);
        switch (pair.shared) {
            case 0:
                return cross(pair.first, pair.second);
            case 1:
                return intersect_besides_vertex(pair);
            case 2:
                return overlap_in_plane(pair);
            default:
                return true;
        }
    }

private:
    [[nodiscard]] const Vec3& at(std::uint32_t vertex) const { return mesh_.vertices[vertex]; }

    [[nodiscard]] bool edge_intersects(std::uint32_t p, std::uint32_t q, const Triangle& t) const {
        return segment_intersects_triangle(at(p), at(q), at(t[0]), at(t[1]), at(t[2]));
    }

    // Triangles without a common vertex intersect when an edge of one intersects the other.
    [[nodiscard]] bool cross(const Triangle& s, const Triangle& t) const {
        return edge_intersects(s[0], s[1], t) || edge_intersects(s[1], s[2], t) || edge_intersects(s[2], s[0], t) ||
               edge_intersects(t[0], t[1], s) || edge_intersects(t[1], t[2], s) || edge_intersects(t[2], t[0], s);
    }

    // From a common vertex, what else is common reaches an edge that is opposite to it.
    [[nodiscard]] bool intersect_besides_vertex(const TrianglePair& pair) const {
        return edge_intersects(pair.first[1], pair.first[2], pair.second) ||
               edge_intersects(pair.second[1], pair.second[2], pair.first);
    }

    // With a common edge: in one plane and on the same side of the edge.
    [[nodiscard]] bool overlap_in_plane(const TrianglePair& pair) const {
        const Vec3& a = at(pair.first[0]);
        const Vec3& b = at(pair.first[1]);
        const Vec3& c = at(pair.first[2]);
        const Vec3& d = at(pair.second[2]);
        if (orient3d(a, b, c, d) != 0) return false;
        return point_on_triangle(d, a, b, c) || point_on_triangle(c, a, b, d) ||
               segment_intersects_triangle(a, d, b, c, c) || segment_intersects_triangle(b, d, a, c, c);
    }

    const TriangleMesh& mesh_;
};

/// The triangles that have an area, and their boxes.
struct TriangleBoxes {
    explicit TriangleBoxes(const TriangleMesh& mesh) {
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const Triangle& t = mesh.triangles[i];
            if (are_collinear(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]])) continue;
            Box3 box;
            for (const std::uint32_t v : t) box.include(mesh.vertices[v]);
            boxes.push_back(box);
            numbers.push_back(i);
        }
    }

    std::vector<std::uint32_t> numbers;
    std::vector<Box3> boxes;
};

std::size_t count_degenerate(const TriangleMesh& mesh) {
    const auto without_area = [&mesh](const Triangle& t) {
        return are_collinear(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    };
    return static_cast<std::size_t>(std::count_if(mesh.triangles.begin(), mesh.triangles.end(), without_area));
}

// "1 edge is", "2 edges are".
std::string counted(std::size_t count, std::string_view one, std::string_view many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

void warn_of_gaps(const MeshReport& report, std::vector<std::string>& warnings) {
    const TopologyReport& topology = report.topology;
    if (topology.closed) return;
    if (topology.boundary_edges == 0) {
        warnings.push_back(
            "not closed, though without an opening: edges belong to three faces or another odd number of them, as "
            "where walls part an inside, or polygons that are listed twice are cut along different diagonals, so "
            "nothing leaks, but inside and outside cannot be told apart");
        return;
    }
    warnings.push_back(fmt::format("open surface, {} in {}: particles pass through the openings",
                                   counted(topology.boundary_edges, "boundary edge", "boundary edges"),
                                   counted(topology.boundary_loops, "loop", "loops")));
    if (report.weld || report.joined_vertices > 0) {
        warnings.push_back(
            "corners are joined only where their coordinates are equal: facets that nearly meet leave a gap as "
            "wide as the difference, through which particles can pass");
    }
}

void warn_of_nonmanifold_parts(const TopologyReport& topology, std::vector<std::string>& warnings) {
    if (topology.nonmanifold_edges > 0) {
        warnings.push_back(
            fmt::format("{} three faces or more: every face stops particles, so nothing leaks, but inside "
                        "and outside may not be told apart there",
                        counted(topology.nonmanifold_edges, "edge belongs to", "edges belong to")));
    }
    if (topology.nonmanifold_vertices > 0) {
        warnings.push_back(
            fmt::format("{} parts of the surface that share no edge there: nothing leaks through a single point",
                        counted(topology.nonmanifold_vertices, "vertex joins", "vertices join")));
    }
}

void warn_of_orientation(const MeshReport& report, std::vector<std::string>& warnings) {
    if (!report.topology.consistently_oriented) {
        warnings.push_back(
            fmt::format("inconsistent winding along {}: faces stop particles from both sides, so nothing leaks, but "
                        "normals and the "
                        "volume cannot be trusted",
                        counted(report.topology.inconsistent_edges, "edge", "edges")));
    }
    if (report.wound_inward) {
        warnings.push_back(
            "wound inside out, the faces' normals point inward: faces stop particles from both sides, so nothing "
            "leaks, "
            "but a mesh emitter on them (without volume) gives birth on the inside and launches inward");
    }
}

void warn_of_odd_faces(const MeshReport& report, std::vector<std::string>& warnings) {
    if (report.degenerate_triangles > 0) {
        warnings.push_back(fmt::format("{} no area and cannot be hit: nothing leaks where neighbours share the edges",
                                       counted(report.degenerate_triangles, "triangle has", "triangles have")));
    }
    if (report.faces_with_repeated_corners > 0) {
        warnings.push_back(fmt::format("{} a vertex more than once: repeated neighbours count once, nothing leaks",
                                       counted(report.faces_with_repeated_corners, "face names", "faces name")));
    }
    if (report.crossing_faces > 0) {
        warnings.push_back(fmt::format(
            "{} an outline that crosses itself: its triangles cover all of it, so nothing leaks, but they overlap",
            counted(report.crossing_faces, "face has", "faces have")));
    }
    if (report.duplicate_faces > 0) {
        warnings.push_back(
            fmt::format("{} an earlier face: nothing leaks, and repeated faces count once where an inside is told from "
                        "an outside",
                        counted(report.duplicate_faces, "face repeats", "faces repeat")));
    }
}

/// Tests of pairs of triangles, for each triangle and in every mesh. Fewer: pairs of ordinary meshes would not all be
/// counted. More: triangles that all cross each other would take time beyond proportion.
constexpr std::size_t kPairTestsPerTriangle = 256;
constexpr std::size_t kPairTests = std::size_t{1} << 20;
constexpr std::size_t kPairBlock = 256;  // triangles that one thread looks at in a row
constexpr std::size_t kPairBlocks = 16;  // that are looked at side by side

/// The pairs of a row of triangles with those behind them, as far as they have been looked for.
struct PairSearch {
    std::size_t next = 0;  ///< triangle
    std::size_t end = 0;
    std::size_t pairs = 0;  ///< found so far
    std::size_t tests = 0;  ///< made so far

    /// Ends with the triangle at which so many more tests have been made.
    void go_on(const BoxTree& tree, const std::vector<Box3>& boxes, const std::vector<std::uint32_t>& numbers,
               const PairTest& intersect, std::size_t most) {
        const std::size_t last = tests + most;
        for (; next < end && tests < last; ++next) {
            tree.for_each_overlap(boxes[next], [&](std::uint32_t j) {
                if (j <= next) return;
                ++tests;
                pairs += intersect(numbers[next], numbers[j]) ? 1 : 0;
            });
        }
    }
};

void warn_of_self_intersections(const MeshReport& report, std::vector<std::string>& warnings) {
    if (report.self_intersections == 0) return;
    warnings.push_back(fmt::format(
        "{}{} or cross each other: every triangle stops particles, so nothing leaks, but where parts overlap "
        "the volume counts "
        "twice",
        report.self_intersections_are_all ? "" : "at least ",
        counted(report.self_intersections, "pair of triangles touch", "pairs of triangles touch")));
}

std::vector<std::string> warnings_for(const MeshReport& report) {
    std::vector<std::string> warnings;
    warn_of_gaps(report, warnings);
    warn_of_nonmanifold_parts(report.topology, warnings);
    warn_of_orientation(report, warnings);
    warn_of_odd_faces(report, warnings);
    warn_of_self_intersections(report, warnings);
    if (report.topology.unused_vertices > 0) {
        warnings.push_back(fmt::format("{} to no face: ignored, nothing leaks",
                                       counted(report.topology.unused_vertices, "vertex belongs", "vertices belong")));
    }
    return warnings;
}

PolygonMesh joined_by_position(const ImportedMesh& imported, const TriangleMesh& joined) {
    std::vector<std::uint32_t> renamed(imported.mesh.vertices.size());
    std::iota(renamed.begin(), renamed.end(), 0U);
    for (std::size_t t = 0; t < joined.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) renamed[imported.mesh.triangles[t][k]] = joined.triangles[t][k];
    }
    PolygonMesh polygons = imported.polygons;
    for (std::uint32_t& corner : polygons.corners) corner = renamed[corner];
    return polygons;
}

}  // namespace

SelfIntersections find_self_intersections(const TriangleMesh& mesh) {
    const TriangleBoxes triangles(mesh);
    const std::vector<std::uint32_t>& numbers = triangles.numbers;
    const std::vector<Box3>& boxes = triangles.boxes;
    const BoxTree tree(boxes);
    const PairTest intersect(mesh);
    std::size_t left = kPairTests + kPairTestsPerTriangle * boxes.size();
    SelfIntersections result;
    // The blocks of a round share the remaining tests in equal parts. Blocks that need more go on one after the other.
    // The end of the search thus does not depend on threads.
    for (std::size_t begin = 0; begin < boxes.size() && left > 0; begin += kPairBlocks * kPairBlock) {
        std::array<PairSearch, kPairBlocks> searches;
        parallel_for_blocks(kPairBlocks, 1, [&](std::size_t, std::size_t first, std::size_t last) {
            for (std::size_t k = first; k < last; ++k) {
                searches[k] = {std::min(boxes.size(), begin + k * kPairBlock),
                               std::min(boxes.size(), begin + (k + 1) * kPairBlock)};
                searches[k].go_on(tree, boxes, numbers, intersect, left / kPairBlocks);
            }
        });
        for (const PairSearch& search : searches) left -= std::min(left, search.tests);
        for (PairSearch& search : searches) {
            const std::size_t before = search.tests;
            search.go_on(tree, boxes, numbers, intersect, left);
            left -= std::min(left, search.tests - before);
            result.pairs += search.pairs;
            result.are_all = result.are_all && search.next == search.end;
        }
        result.are_all = result.are_all && (left > 0 || begin + kPairBlocks * kPairBlock >= boxes.size());
    }
    return result;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> intersections_between(const TriangleMesh& mesh,
                                                                           const std::vector<std::uint32_t>& part_of,
                                                                           std::size_t most) {
    const PairTest intersect(mesh);
    const TriangleBoxes triangles(mesh);
    const std::vector<std::uint32_t>& numbers = triangles.numbers;
    const BoxTree tree(triangles.boxes);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    std::size_t left = kPairTests + kPairTestsPerTriangle * numbers.size();
    for (std::size_t i = 0; i < numbers.size() && pairs.size() < most && left > 0; ++i) {
        tree.for_each_overlap(triangles.boxes[i], [&](std::uint32_t j) {
            if (j <= i || left == 0) return;
            --left;
            if (part_of[numbers[i]] == part_of[numbers[j]] || pairs.size() == most) return;
            if (intersect(numbers[i], numbers[j])) pairs.emplace_back(numbers[i], numbers[j]);
        });
    }
    return pairs;
}

MeshReport report_on(const ImportedMesh& imported) {
    MeshReport report;
    report.format = imported.format;
    report.vertices = imported.polygons.vertices.size();
    report.faces = imported.polygons.face_count();
    report.triangles = imported.mesh.triangles.size();
    report.bounds = bounds(imported.mesh);
    report.area = surface_area(imported.mesh);
    const TriangleMesh joined = joined_by_position(imported.mesh);
    report.topology = MeshTopology(joined).report();
    const std::size_t unused = count_unused_vertices(imported.mesh);
    report.joined_vertices = report.topology.unused_vertices - unused;
    report.topology.unused_vertices = unused;
    report.duplicate_faces = count_duplicate_faces(joined_by_position(imported, joined));
    if (report.topology.closed) {
        const double volume = signed_volume(counted_surface(imported.mesh));
        report.volume = std::fabs(volume);
        report.wound_inward = report.topology.consistently_oriented && volume < 0.0;
    }
    report.degenerate_triangles = count_degenerate(imported.mesh);
    const SelfIntersections found = find_self_intersections(joined);
    report.self_intersections = found.pairs;
    report.self_intersections_are_all = found.are_all;
    report.faces_with_repeated_corners = imported.faces_with_repeated_corners;
    report.crossing_faces = imported.crossing_faces;
    report.weld = imported.weld;
    report.y_up = imported.y_up;
    report.names = named_triangles(imported);
    report.notes = imported.notes;
    report.warnings = warnings_for(report);
    return report;
}

}  // namespace ricochet
