#include "ricochet/geometry/mesh/triangle_mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// A mathematical constant.
constexpr double kPi = 3.14159265358979323846;
constexpr std::uint32_t kSides = 96;  // around the axis
constexpr std::uint32_t kBelts = 48;  // from pole to pole of a ball

/// Adds the points of a circle around the z axis.
void add_ring(TriangleMesh& mesh, double radius, double z) {
    for (std::uint32_t k = 0; k < kSides; ++k) {
        const double angle = 2.0 * kPi * k / kSides;
        mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
}

/// Adds two triangles for every side between two rings. `lower` is the first vertex of the lower ring.
void add_belt(TriangleMesh& mesh, std::uint32_t lower, std::uint32_t upper) {
    for (std::uint32_t k = 0; k < kSides; ++k) {
        const std::uint32_t next = (k + 1) % kSides;
        mesh.triangles.push_back({lower + k, lower + next, upper + next});
        mesh.triangles.push_back({lower + k, upper + next, upper + k});
    }
}

/// Adds a fan around a point on the axis, facing up or down.
void add_fan(TriangleMesh& mesh, std::uint32_t apex, std::uint32_t ring, bool up) {
    for (std::uint32_t k = 0; k < kSides; ++k) {
        const std::uint32_t next = (k + 1) % kSides;
        mesh.triangles.push_back(up ? Triangle{apex, ring + k, ring + next} : Triangle{apex, ring + next, ring + k});
    }
}

void require_length(double value, const char* what) {
    if (!(value > 0.0 && std::isfinite(value))) {
        throw InputError(fmt::format("{}: found {}, expected a finite number above 0 (m)", what, value));
    }
}

}  // namespace

void require_corners(const TriangleMesh& mesh) {
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t v : t) require_index(v, mesh.vertices.size(), "corner of a triangle");
    }
}

Box3 bounds(const TriangleMesh& mesh) {
    require_corners(mesh);
    Box3 box;
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t v : t) box.include(mesh.vertices[v]);
    }
    return box;
}

double surface_area(const TriangleMesh& mesh) {
    require_corners(mesh);
    double area = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        area += 0.5 * length(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
    }
    return area;
}

double signed_volume(const TriangleMesh& mesh) {
    require_corners(mesh);
    if (mesh.triangles.empty()) return 0.0;
    // The volume is computed relative to a point of the mesh, because a distant origin would cause cancellation.
    const Vec3 origin = mesh.vertices[mesh.triangles.front()[0]];
    double six_volumes = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]] - origin;
        const Vec3 b = mesh.vertices[t[1]] - origin;
        const Vec3 c = mesh.vertices[t[2]] - origin;
        six_volumes += dot(a, cross(b, c));
    }
    return six_volumes / 6.0;
}

TriangleMesh transformed(const TriangleMesh& mesh, const Placement& placement) {
    const AffineMap map = world_from_local(placement);
    TriangleMesh result;
    result.vertices.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) result.vertices.push_back(flush_tiny(map.point(v)));
    result.triangles = mesh.triangles;
    if (map.mirrors()) {
        for (Triangle& t : result.triangles) std::swap(t[1], t[2]);
    }
    return result;
}

TriangleMesh ball_mesh(double radius, const Placement& placement) {
    require_length(radius, "radius of a ball");
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, -radius}, {0, 0, radius}};
    for (std::uint32_t belt = 1; belt < kBelts; ++belt) {
        const double angle = kPi * belt / kBelts;
        add_ring(mesh, radius * std::sin(angle), -radius * std::cos(angle));
    }
    add_fan(mesh, 0, 2, false);
    for (std::uint32_t belt = 1; belt + 1 < kBelts; ++belt) {
        add_belt(mesh, 2 + (belt - 1) * kSides, 2 + belt * kSides);
    }
    add_fan(mesh, 1, 2 + (kBelts - 2) * kSides, true);
    return transformed(mesh, placement);
}

TriangleMesh cylinder_mesh(double radius, double height, const Placement& placement) {
    require_length(radius, "radius of a cylinder");
    require_length(height, "height of a cylinder");
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, -0.5 * height}, {0, 0, 0.5 * height}};
    add_ring(mesh, radius, -0.5 * height);
    add_ring(mesh, radius, 0.5 * height);
    add_fan(mesh, 0, 2, false);
    add_belt(mesh, 2, 2 + kSides);
    add_fan(mesh, 1, 2 + kSides, true);
    return transformed(mesh, placement);
}

TriangleMesh cuboid_mesh(const Vec3& size) {
    for (int axis = 0; axis < 3; ++axis) require_length(size[axis], "size of a box");
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        mesh.vertices.push_back({(corner & 1) != 0 ? 0.5 * size.x : -0.5 * size.x,
                                 (corner & 2) != 0 ? 0.5 * size.y : -0.5 * size.y,
                                 (corner & 4) != 0 ? 0.5 * size.z : -0.5 * size.z});
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

}  // namespace ricochet
