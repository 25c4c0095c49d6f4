/// \file Short constructors of collision worlds for tests.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/collision/contact_query.h"

namespace ricochet::testing {

inline ColliderDescription mesh_collider(TriangleMesh mesh, const Placement& placement = {},
                                         const std::string& name = "mesh") {
    return {name, MeshShape{std::make_shared<const TriangleMesh>(std::move(mesh)), placement, ""}, 0};
}

inline ColliderDescription plane_collider(const Vec3& point, const Vec3& normal, const std::string& name = {}) {
    return {name, PlaneShape{point, normal}, 0};
}

template <class... Colliders>
CollisionWorld world_of(Colliders... colliders) {
    return CollisionWorld(std::vector<ColliderDescription>{std::move(colliders)...});
}

/// Runs one query, for tests of many worlds and paths.
inline ContactQueryResult query(const CollisionWorld& world, ContactScratch& scratch, const Path& path, double radius,
                                const LookAhead* look_ahead = nullptr, const ContactCandidates& candidates = {}) {
    const SurfaceGeometry geometry(world, scratch.plane_cache);
    return find_first_contact(geometry, {path, radius, look_ahead, candidates}, scratch);
}

/// Returns the square [-half, half]^2 at height z, with cells x cells squares of two triangles each and upward normals.
inline TriangleMesh floor_mesh(double half, int cells, double z = 0.0) {
    TriangleMesh mesh;
    const auto n = static_cast<std::uint32_t>(cells);
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            mesh.vertices.push_back({-half + 2.0 * half * i / n, -half + 2.0 * half * j / n, z});
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t v = j * (n + 1) + i;
            mesh.triangles.push_back({v, v + 1, v + n + 2});
            mesh.triangles.push_back({v, v + n + 2, v + n + 1});
        }
    }
    return mesh;
}

}  // namespace ricochet::testing
