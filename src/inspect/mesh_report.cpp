#include "inspect/mesh_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string_view>
#include <vector>

#include "inspect/self_intersections.h"
#include "inspect/shells.h"
#include "ricochet/geometry/mesh/closed_surface.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// Returns the mesh without the triangles that repeat an earlier one in the same winding. Vertices at equal positions
/// must be joined before.
TriangleMesh without_copies(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> number;  // triangle of each face
    std::vector<std::uint32_t> copies = copied_faces(faces_of(mesh, &number));
    for (std::uint32_t& face : copies) face = number[face];
    TriangleMesh distinct{mesh.vertices, {}};
    for_each_counted(mesh, copies, [&](std::uint32_t t) { distinct.triangles.push_back(mesh.triangles[t]); });
    return distinct;
}

std::size_t count_degenerate(const TriangleMesh& mesh) {
    const auto without_area = [&mesh](const Triangle& t) {
        return are_collinear(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    };
    return static_cast<std::size_t>(std::count_if(mesh.triangles.begin(), mesh.triangles.end(), without_area));
}

// Formats a count with its noun: "1 edge is", "2 edges are".
std::string counted(std::size_t count, std::string_view one, std::string_view many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

void warn_of_gaps(const MeshReport& report, std::vector<std::string>& warnings) {
    const TopologyReport& topology = report.topology;
    if (topology.closed) return;
    if (topology.boundary_edges == 0) {
        warnings.push_back(
            "not closed, though without an opening: edges belong to three faces or another odd number (inner "
            "walls, or polygons that are listed twice and cut along different diagonals); nothing leaks, but inside "
            "and outside cannot be told apart");
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
        warnings.push_back(fmt::format("{} three faces or more: every face stops particles, so nothing leaks there{}",
                                       counted(topology.nonmanifold_edges, "edge belongs to", "edges belong to"),
                                       topology.closed ? "" : ", but inside and outside may not be told apart"));
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
            fmt::format("inconsistent winding along {}: faces stop particles from both sides, so nothing leaks "
                        "there, but normals and the volume cannot be trusted",
                        counted(report.topology.inconsistent_edges, "edge", "edges")));
    }
    if (report.wound_inward) {
        warnings.push_back(
            "wound inside out, the faces' normals point inward: faces stop particles from both sides, so nothing "
            "leaks through them, but a mesh emitter on them (without volume) spawns particles on the inside and "
            "launches them inward");
    }
}

void warn_of_odd_faces(const MeshReport& report, std::vector<std::string>& warnings) {
    if (report.degenerate_triangles > 0) {
        warnings.push_back(
            fmt::format("{} no area and cannot be hit: nothing leaks there if neighbours share the "
                        "edges",
                        counted(report.degenerate_triangles, "triangle has", "triangles have")));
    }
    if (report.faces_with_repeated_corners > 0) {
        warnings.push_back(
            fmt::format("{} a vertex more than once: repeated neighbours count once, nothing leaks there",
                        counted(report.faces_with_repeated_corners, "face names", "faces name")));
    }
    if (report.crossing_faces > 0) {
        warnings.push_back(
            fmt::format("{} an outline that crosses itself: its triangles cover all of it, so nothing leaks there, but "
                        "they overlap",
                        counted(report.crossing_faces, "face has", "faces have")));
    }
    if (report.duplicate_faces > 0) {
        warnings.push_back(
            fmt::format("{} an earlier face: nothing leaks there, and repeated faces count once where an inside is "
                        "told from an outside, unless both sides of a sheet or a wall are listed",
                        counted(report.duplicate_faces, "face repeats", "faces repeat")));
    }
}

void warn_of_self_intersections(const MeshReport& report, std::vector<std::string>& warnings) {
    if (report.self_intersections == 0) return;
    warnings.push_back(
        fmt::format("{}{} or cross each other: every triangle stops particles, so nothing leaks there, but where parts "
                    "overlap the volume counts twice",
                    report.self_intersections_are_all ? "" : "at least ",
                    counted(report.self_intersections, "pair of triangles touch", "pairs of triangles touch")));
}

void warn_of_nested_shells(const MeshReport& report, std::vector<std::string>& warnings) {
    if (report.shells_nested_alike == 0) return;
    warnings.push_back(fmt::format(
        "{} within another that is wound the same way: parity decides the inside, so inside and outside alternate from "
        "shell to shell, but the volume is the sum of all: reverse every second shell to get the volume of the walls",
        counted(report.shells_nested_alike, "shell lies", "shells lie")));
}

std::vector<std::string> warnings_for(const MeshReport& report) {
    std::vector<std::string> warnings;
    warn_of_gaps(report, warnings);
    warn_of_nonmanifold_parts(report.topology, warnings);
    warn_of_orientation(report, warnings);
    warn_of_odd_faces(report, warnings);
    warn_of_self_intersections(report, warnings);
    warn_of_nested_shells(report, warnings);
    if (report.topology.unused_vertices > 0) {
        warnings.push_back(fmt::format("{} to no face: ignored",
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

MeshReport report_on(const ImportedMesh& imported) {
    MeshReport report;
    report.format = imported.format;
    report.vertices = imported.polygons.vertices.size();
    report.faces = imported.polygons.face_count();
    report.triangles = imported.mesh.triangles.size();
    report.bounds = bounds(imported.mesh);
    report.area = surface_area(imported.mesh);
    const TriangleMesh joined = joined_by_position(imported.mesh);
    const TriangleMesh distinct = without_copies(joined);
    report.topology = MeshTopology(distinct).report();
    const std::size_t unused = count_unused_vertices(imported.mesh);
    report.joined_vertices = report.topology.unused_vertices - unused;
    report.topology.unused_vertices = unused;
    report.duplicate_faces = count_duplicate_faces(joined_by_position(imported, joined));
    if (report.topology.closed) {
        const double volume = signed_volume(counted_surface(imported.mesh));
        report.volume = std::fabs(volume);
        if (report.topology.consistently_oriented && !shells_overlap(distinct)) {
            report.shells_nested_alike = count_shells_nested_alike(distinct);
        }
        report.wound_inward = report.topology.consistently_oriented && volume < 0.0;
    }
    report.degenerate_triangles = count_degenerate(imported.mesh);
    const SelfIntersections found = find_self_intersections(distinct);
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
