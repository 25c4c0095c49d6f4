#include "ricochet/geometry/mesh/closed_surface.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <utility>

#include "ricochet/geometry/mesh/mesh_interior.h"
#include "ricochet/geometry/mesh/mesh_report.h"
#include "ricochet/geometry/mesh/vertex_welder.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

constexpr std::uint32_t kUnknown = std::numeric_limits<std::uint32_t>::max();

std::vector<std::uint32_t> faces_of_corners(const FaceList& faces) {
    std::vector<std::uint32_t> face_of(faces.corners.size());
    for (std::uint32_t f = 0; f < faces.face_count(); ++f) {
        std::fill(face_of.begin() + faces.face_offsets[f], face_of.begin() + faces.face_offsets[f + 1], f);
    }
    return face_of;
}

/// How the edges of a shell are used.
struct ShellParity {
    bool is_odd_once = false;  ///< an edge has an odd number of faces if repeated ones count once
    bool is_odd = false;       ///< the same if all of them count
};

/// Returns true if each edge has as many faces in either direction.
bool is_oriented(const FaceList& faces, const EdgeTable& edges, const std::vector<std::uint32_t>& left_out) {
    const std::vector<std::uint32_t> face_of =
        left_out.empty() ? std::vector<std::uint32_t>{} : faces_of_corners(faces);
    bool oriented = true;
    edges.for_each_edge([&](std::span<const std::uint32_t> uses) {
        std::int64_t excess = 0;
        for (const std::uint32_t use : uses) {
            if (!left_out.empty() && std::binary_search(left_out.begin(), left_out.end(), face_of[use])) continue;
            excess += faces.corners[use] < faces.corners[faces.next_corner[use]] ? 1 : -1;
        }
        oriented = oriented && excess == 0;
    });
    return oriented;
}

ClosedSurface choose_by_shell(const FaceList& faces, const EdgeTable& edges, std::vector<std::uint32_t> repeated) {
    const std::vector<std::uint32_t> face_of = faces_of_corners(faces);
    std::vector<char> is_repeated(faces.face_count(), 0);
    for (const std::uint32_t f : repeated) is_repeated[f] = 1;
    DisjointSets shells(faces.face_count());
    edges.for_each_edge([&](std::span<const std::uint32_t> uses) {
        for (const std::uint32_t use : uses.subspan(1)) shells.join(face_of[uses[0]], face_of[use]);
    });
    std::vector<ShellParity> parity(faces.face_count());
    edges.for_each_edge([&](std::span<const std::uint32_t> uses) {
        const auto once =
            std::count_if(uses.begin(), uses.end(), [&](std::uint32_t use) { return is_repeated[face_of[use]] == 0; });
        ShellParity& shell = parity[shells.find(face_of[uses[0]])];
        shell.is_odd_once = shell.is_odd_once || once % 2 != 0;
        shell.is_odd = shell.is_odd || uses.size() % 2 != 0;
    });
    ClosedSurface result{true, false, std::move(repeated)};
    for (const ShellParity& shell : parity) result.closed = result.closed && !(shell.is_odd_once && shell.is_odd);
    const auto counts = [&](std::uint32_t f) {
        const ShellParity& shell = parity[shells.find(f)];
        return shell.is_odd_once && !shell.is_odd;
    };
    result.left_out.erase(std::remove_if(result.left_out.begin(), result.left_out.end(), counts),
                          result.left_out.end());
    result.oriented = result.closed && is_oriented(faces, edges, result.left_out);
    return result;
}

/// Returns the smallest triangle of its shell for each triangle.
std::vector<std::uint32_t> shells_of(const TriangleMesh& joined) {
    std::vector<std::uint32_t> number;
    const FaceList faces = faces_of(joined, &number);
    const std::vector<std::uint32_t> face_of = faces_of_corners(faces);
    DisjointSets shells(joined.triangles.size());
    EdgeTable(faces, joined.vertices.size()).for_each_edge([&](std::span<const std::uint32_t> uses) {
        for (const std::uint32_t use : uses.subspan(1)) shells.join(number[face_of[uses[0]]], number[face_of[use]]);
    });
    std::vector<std::uint32_t> shell_of(joined.triangles.size());
    for (std::uint32_t t = 0; t < shell_of.size(); ++t) shell_of[t] = shells.find(t);
    return shell_of;
}

TriangleMesh shell_alone(const TriangleMesh& mesh, const std::vector<std::uint32_t>& shell_of, std::uint32_t shell) {
    TriangleMesh alone;
    std::vector<std::uint32_t> renamed(mesh.vertices.size(), kUnknown);
    for (std::size_t t = 0; t < shell_of.size(); ++t) {
        if (shell_of[t] != shell) continue;
        Triangle triangle = mesh.triangles[t];
        for (std::uint32_t& v : triangle) {
            if (renamed[v] == kUnknown) {
                renamed[v] = static_cast<std::uint32_t>(alone.vertices.size());
                alone.vertices.push_back(mesh.vertices[v]);
            }
            v = renamed[v];
        }
        alone.triangles.push_back(triangle);
    }
    return alone;
}

Vec3 centroid(const TriangleMesh& mesh, std::uint32_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3.0;
}

/// Returns true if an edge of the first passes through the inside of the second.
bool pierces(const TriangleMesh& mesh, const Triangle& first, const Triangle& second) {
    const auto at = [&](std::uint32_t v) -> const Vec3& { return mesh.vertices[v]; };
    const auto& [a, b, c] = second;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p = at(first[k]);
        const Vec3& q = at(first[(k + 1) % 3]);
        if (orient3d(at(a), at(b), at(c), p) * orient3d(at(a), at(b), at(c), q) >= 0) continue;
        const int side = orient3d(p, q, at(a), at(b));
        if (side != 0 && side == orient3d(p, q, at(b), at(c)) && side == orient3d(p, q, at(c), at(a))) return true;
    }
    return false;
}

bool cross_properly(const TriangleMesh& mesh, std::uint32_t first, std::uint32_t second) {
    return pierces(mesh, mesh.triangles[first], mesh.triangles[second]) ||
           pierces(mesh, mesh.triangles[second], mesh.triangles[first]);
}

/// Returns true if the first triangle comes out of the second one's plane at a place from which it leads into a shell:
/// halfway from there to a corner, and on both sides of the triangle, which a shell that only touches does not hold.
bool leads_into(const MeshInterior& shell, const TriangleMesh& mesh, std::uint32_t first, std::uint32_t second) {
    constexpr double kBeside = 1e-6;  // part of the edge's length
    const auto& [a, b, c] = mesh.triangles[second];
    const Vec3& origin = mesh.vertices[a];
    const Vec3 normal = cross(mesh.vertices[b] - origin, mesh.vertices[c] - origin);
    const auto& [i, j, k] = mesh.triangles[first];
    const Vec3 own = cross(mesh.vertices[j] - mesh.vertices[i], mesh.vertices[k] - mesh.vertices[i]);
    const double size = length(own);
    if (!(size > 0.0)) return false;
    for (const auto& [from, to] : {std::pair(i, j), std::pair(j, k), std::pair(k, i)}) {
        const Vec3& p = mesh.vertices[from];
        const Vec3& q = mesh.vertices[to];
        const double before = dot(normal, p - origin);
        const double after = dot(normal, q - origin);
        if (!(before * after < 0.0)) continue;
        const Vec3 met = p + (before / (before - after)) * (q - p);
        const Vec3 beside = (kBeside * length(q - p) / size) * own;
        for (const Vec3& place : {0.5 * (p + met), 0.5 * (met + q)}) {
            if (shell.contains(place + beside) && shell.contains(place - beside)) return true;
        }
    }
    return false;
}

}  // namespace

ClosedSurface closed_surface(const FaceList& faces, const EdgeTable& edges) {
    std::vector<std::uint32_t> repeated = repeated_faces(faces);
    if (!repeated.empty()) return choose_by_shell(faces, edges, std::move(repeated));
    ClosedSurface result{faces.face_count() > 0, false, {}};
    edges.for_each_edge(
        [&](std::span<const std::uint32_t> uses) { result.closed = result.closed && uses.size() % 2 == 0; });
    result.oriented = result.closed && is_oriented(faces, edges, {});
    return result;
}

ClosedSurface closed_surface(const TriangleMesh& mesh) {
    const TriangleMesh joined = joined_by_position(mesh);
    std::vector<std::uint32_t> number;  // of the triangle that each face is
    const FaceList faces = faces_of(joined, &number);
    ClosedSurface result = closed_surface(faces, EdgeTable(faces, joined.vertices.size()));
    for (std::uint32_t& face : result.left_out) face = number[face];
    return result;
}

TriangleMesh joined_by_position(const TriangleMesh& mesh) {
    TriangleMesh joined = mesh;
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> first_at;  // vertex, per position
    std::vector<std::uint32_t> renamed(mesh.vertices.size(), kUnknown);
    VertexWelder welder(positions);
    for (Triangle& t : joined.triangles) {
        for (std::uint32_t& v : t) {
            if (renamed[v] == kUnknown) {
                const std::uint32_t position = welder.index_of(mesh.vertices[v]);
                if (position == first_at.size()) first_at.push_back(v);
                renamed[v] = first_at[position];
            }
            v = renamed[v];
        }
    }
    return joined;
}

bool shells_overlap(const TriangleMesh& mesh) {
    const TriangleMesh joined = counted_surface(mesh);
    const std::vector<std::uint32_t> shell_of = shells_of(joined);
    if (std::all_of(shell_of.begin(), shell_of.end(), [](std::uint32_t shell) { return shell == 0; })) return false;
    constexpr std::size_t kMostPairs = 4096;
    constexpr std::size_t kMostInteriors = 256;
    const auto pairs = intersections_between(joined, shell_of, kMostPairs);
    for (const auto& [first, second] : pairs) {
        if (cross_properly(joined, first, second)) return true;
    }
    std::map<std::uint32_t, MeshInterior> interiors;
    for (const auto& [first, second] : pairs) {
        for (const auto& [triangle, other] : {std::pair(first, second), std::pair(second, first)}) {
            const std::uint32_t shell = shell_of[other];
            if (interiors.size() == kMostInteriors && interiors.count(shell) == 0) continue;
            const auto found = interiors.try_emplace(
                shell, std::make_shared<const TriangleMesh>(shell_alone(joined, shell_of, shell)));
            const MeshInterior& interior = found.first->second;
            if (interior.contains(centroid(joined, triangle)) || leads_into(interior, joined, triangle, other))
                return true;
        }
    }
    return false;
}

TriangleMesh counted_surface(const TriangleMesh& mesh) {
    const std::vector<std::uint32_t> left_out = closed_surface(mesh).left_out;
    TriangleMesh counted = joined_by_position(mesh);
    if (left_out.empty()) return counted;
    auto next = left_out.begin();
    std::size_t kept = 0;
    for (std::uint32_t t = 0; t < counted.triangles.size(); ++t) {
        if (next != left_out.end() && *next == t) {
            ++next;
        } else {
            counted.triangles[kept++] = counted.triangles[t];
        }
    }
    counted.triangles.resize(kept);
    return counted;
}

}  // namespace ricochet
