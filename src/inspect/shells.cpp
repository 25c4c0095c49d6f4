#include "inspect/shells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "inspect/self_intersections.h"
#include "ricochet/core/disjoint_sets.h"
#include "ricochet/geometry/mesh/closed_surface.h"
#include "ricochet/geometry/mesh/edge_table.h"
#include "ricochet/geometry/mesh/mesh_interior.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

constexpr std::uint32_t kUnknown = std::numeric_limits<std::uint32_t>::max();

/// Returns the number of the shell of each triangle. A shell's number is the smallest index of its triangles.
std::vector<std::uint32_t> shells_of(const TriangleMesh& joined) {
    std::vector<std::uint32_t> number;
    const FaceList faces = faces_of(joined, &number);
    std::vector<std::uint32_t> face_of(faces.corners.size());
    for (std::uint32_t f = 0; f < faces.face_count(); ++f) {
        std::fill(face_of.begin() + faces.face_offsets[f], face_of.begin() + faces.face_offsets[f + 1], f);
    }
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

/// Returns true if an edge of the first triangle passes through the interior of the second triangle.
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

/// Returns true if the first triangle extends into the shell of the second triangle. The test uses each edge of the
/// first triangle that crosses the second triangle's plane. The point halfway between the crossing and a corner is
/// moved slightly to both sides of the first triangle. The shell must contain both moved points, because a shell that
/// only touches the triangle contains at most one.
bool leads_into(const MeshInterior& shell, const TriangleMesh& mesh, std::uint32_t first, std::uint32_t second) {
    // Local, because it is the offset of a test position and not a tolerance.
    constexpr double kBeside = 1e-6;  // fraction of the edge's length
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

/// Interiors of the shells of a mesh, created on demand.
class Interiors {
public:
    Interiors(const TriangleMesh& joined, const std::vector<std::uint32_t>& shell_of)
        : joined_(joined), shell_of_(shell_of) {}

    /// Returns the interior of a shell, or nullptr if interiors of too many other shells exist already.
    const MeshInterior* of(std::uint32_t shell) {
        constexpr std::size_t kMostInteriors = 256;
        if (interiors_.size() == kMostInteriors && interiors_.count(shell) == 0) return nullptr;
        const auto found =
            interiors_.try_emplace(shell, std::make_shared<const TriangleMesh>(shell_alone(joined_, shell_of_, shell)));
        return &found.first->second;
    }

    /// Returns true if the first shell is inside the second; their surfaces may touch. The second shell must contain a
    /// point close to the centroid of each triangle of the first shell. These points are on the inner side of the
    /// triangles.
    bool is_within(std::uint32_t inner, std::uint32_t outer) {
        const auto [known, is_new] = within_.try_emplace({inner, outer}, true);
        for (std::uint32_t t = 0; is_new && known->second && t < shell_of_.size(); ++t) {
            if (shell_of_[t] != inner) continue;
            for (const Vec3& point : beside(t)) {
                if (of(inner)->contains(point) && !of(outer)->contains(point)) known->second = false;
            }
        }
        return known->second;
    }

private:
    /// Returns two points close to the triangle's centroid, one on each side.
    [[nodiscard]] std::array<Vec3, 2> beside(std::uint32_t triangle) const {
        // Local, because it is the offset of a test position and not a tolerance.
        constexpr double kBeside = 1e-6;  // fraction of the triangle's size
        const auto& [a, b, c] = joined_.triangles[triangle];
        const Vec3 normal = cross(joined_.vertices[b] - joined_.vertices[a], joined_.vertices[c] - joined_.vertices[a]);
        const double size = length(normal);
        const Vec3 offset = size > 0.0 ? (kBeside * std::sqrt(size) / size) * normal : Vec3{0.0, 0.0, 0.0};
        return {centroid(joined_, triangle) + offset, centroid(joined_, triangle) - offset};
    }

    const TriangleMesh& joined_;
    const std::vector<std::uint32_t>& shell_of_;
    std::map<std::uint32_t, MeshInterior> interiors_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, bool> within_;
};

/// Signed volume of one shell, in m^3, and the sum of the magnitudes of its terms.
struct ShellVolume {
    double sum = 0.0;
    double magnitude = 0.0;

    /// Returns 1 if the shell is wound outward and -1 if it is wound inward. Returns 0 if the sum is not larger than
    /// its rounding error, as for a flat shell.
    [[nodiscard]] int orientation() const {
        // Local, because it bounds only the rounding error of this sum.
        constexpr double kRounding = 1e-12;  // far above the sum's rounding error
        if (!(std::fabs(sum) > kRounding * magnitude)) return 0;
        return sum > 0.0 ? 1 : -1;
    }
};

/// Returns the volume of each shell, at the index of its first triangle.
std::vector<ShellVolume> shell_volumes(const TriangleMesh& mesh, const std::vector<std::uint32_t>& shell_of) {
    std::vector<ShellVolume> volumes(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Vec3& origin = mesh.vertices[mesh.triangles[shell_of[t]][0]];
        const auto& [a, b, c] = mesh.triangles[t];
        const double part =
            dot(mesh.vertices[a] - origin, cross(mesh.vertices[b] - origin, mesh.vertices[c] - origin)) / 6.0;
        volumes[shell_of[t]].sum += part;
        volumes[shell_of[t]].magnitude += std::fabs(part);
    }
    return volumes;
}

}  // namespace

std::size_t count_shells_nested_alike(const TriangleMesh& mesh) {
    const auto counted = std::make_shared<const TriangleMesh>(counted_surface(mesh));
    const std::vector<std::uint32_t> shell_of = shells_of(*counted);
    if (std::all_of(shell_of.begin(), shell_of.end(), [](std::uint32_t shell) { return shell == 0; })) return 0;
    const std::vector<ShellVolume> volumes = shell_volumes(*counted, shell_of);
    const MeshInterior interior(counted, {});
    std::vector<char> is_nested(shell_of.size(), 0);
    for (const std::uint32_t shell : shell_of) is_nested[shell] = 1;
    for (std::size_t t = 0; t < shell_of.size(); ++t) {
        const std::uint32_t shell = shell_of[t];
        for (const std::uint32_t v : counted->triangles[t]) {
            if (is_nested[shell] == 0) break;
            const std::int64_t winding = interior.winding_without(counted->vertices[v], shell_of, shell);
            is_nested[shell] = volumes[shell].orientation() * winding > 0 ? 1 : 0;
        }
    }
    return static_cast<std::size_t>(std::count(is_nested.begin(), is_nested.end(), 1));
}

bool shells_overlap(const TriangleMesh& mesh) {
    const TriangleMesh joined = counted_surface(mesh);
    const std::vector<std::uint32_t> shell_of = shells_of(joined);
    if (std::all_of(shell_of.begin(), shell_of.end(), [](std::uint32_t shell) { return shell == 0; })) return false;
    constexpr std::size_t kMostPairs = 4096;
    const auto pairs = intersections_between(joined, shell_of, kMostPairs);
    for (const auto& [first, second] : pairs) {
        if (cross_properly(joined, first, second)) return true;
    }
    Interiors interiors(joined, shell_of);
    for (const auto& [first, second] : pairs) {
        for (const auto& [triangle, other] : {std::pair(first, second), std::pair(second, first)}) {
            const MeshInterior* const interior = interiors.of(shell_of[other]);
            const MeshInterior* const own = interiors.of(shell_of[triangle]);
            if (interior == nullptr || own == nullptr) continue;
            const bool meets_inside =
                interior->contains(centroid(joined, triangle)) || leads_into(*interior, joined, triangle, other);
            if (meets_inside && !interiors.is_within(shell_of[triangle], shell_of[other])) return true;
        }
    }
    return false;
}

}  // namespace ricochet
