/// \file
/// Descriptions of colliders, as a scene gives them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "ricochet/core/transform.h"
#include "ricochet/geometry/mesh/mesh_motion.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// An infinite plane. It is solid from both sides: particles on either side stay there.
struct PlaneShape {
    Vec3 point;
    Vec3 normal{0, 0, 1};  ///< any length but 0
};

/// A triangle mesh, solid from both sides. The collision world applies scale, rotation and position to its vertices.
struct MeshShape {
    std::shared_ptr<const TriangleMesh> mesh;
    Placement placement;
    std::string file;  ///< source file, for messages and reports; may be empty
    /// Material of every triangle, as indices into the simulation's materials; empty: all have the collider's material.
    std::vector<std::uint32_t> triangle_materials = {};
    /// Positions of a deforming mesh's vertices over time, before the placement, instead of `mesh`'s; null if rigid.
    std::shared_ptr<const MeshMotion> motion = nullptr;
};

/// A ball about the local origin: a sphere, or an ellipsoid if the scale differs by axis. It is solid from both sides.
struct BallShape {
    double radius = 1.0;  ///< in m, > 0
    Placement placement;
};

/// A cylinder about the local z axis with flat caps, centred on the origin. It is solid from both sides.
struct CylinderShape {
    double radius = 1.0;  ///< in m, > 0
    double height = 1.0;  ///< in m, > 0
    Placement placement;
};

/// A box about the local origin. It collides as its twelve triangles.
struct CuboidShape {
    Vec3 size{1, 1, 1};  ///< full edge lengths, in m, > 0
    Placement placement;
};

/// Returns the map of the unit ball onto a ball collider.
[[nodiscard]] inline AffineMap world_from_unit(const BallShape& ball) {
    Placement placement = ball.placement;
    placement.scale *= ball.radius;
    return world_from_local(placement);
}

/// Returns the map of the cylinder x^2 + y^2 <= 1, |z| <= 1 onto a cylinder collider.
[[nodiscard]] inline AffineMap world_from_unit(const CylinderShape& cylinder) {
    Placement placement = cylinder.placement;
    placement.scale.x *= cylinder.radius;
    placement.scale.y *= cylinder.radius;
    placement.scale.z *= 0.5 * cylinder.height;
    return world_from_local(placement);
}

/// A shape that particles can collide with.
using ColliderShape = std::variant<PlaneShape, MeshShape, BallShape, CylinderShape, CuboidShape>;

/// Returns the name of a shape in scenes and files: plane, mesh, sphere, cylinder or box.
[[nodiscard]] inline const char* type_name(const ColliderShape& shape) {
    constexpr std::array<const char*, std::variant_size_v<ColliderShape>> kNames{"plane", "mesh", "sphere", "cylinder",
                                                                                 "box"};
    return kNames[shape.index()];
}

/// One collider of a scene.
struct ColliderDescription {
    std::string name;
    ColliderShape shape;
    std::uint32_t material = 0;  ///< index into the simulation's materials
    /// Frame that the collider moves with, and to which its placement is relative. Empty: it is at rest in the world.
    std::string frame = {};
};

/// Returns true if the collider is a mesh whose vertices move.
[[nodiscard]] inline bool is_deforming(const ColliderDescription& collider) {
    const auto* const mesh = std::get_if<MeshShape>(&collider.shape);
    return mesh != nullptr && mesh->motion != nullptr;
}

/// Calls visit(material) for the materials of a collider and of its triangles. It may visit a material more than once.
template <class Visit>
void visit_materials(const ColliderDescription& collider, const Visit& visit) {
    visit(collider.material);
    const auto* mesh = std::get_if<MeshShape>(&collider.shape);
    if (mesh == nullptr) return;
    for (const std::uint32_t material : mesh->triangle_materials) visit(material);
}

}  // namespace ricochet
