/// \file
/// Colliders as a scene describes them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>

#include "ricochet/core/transform.h"
#include "ricochet/geometry/triangle_mesh.h"

namespace ricochet {

/// An infinite plane; solid on both sides (particles on either side stay there).
struct PlaneShape {
    Vec3 point;
    Vec3 normal{0, 0, 1};  ///< need not be of unit length; not zero
};

/// A triangle mesh, two-sided. Scale, rotation and position are baked into world coordinates.
struct MeshShape {
    std::shared_ptr<const TriangleMesh> mesh;
    Placement placement;
    std::string file;  ///< where it came from, for messages and reports; may be empty
};

/// One collider of a scene.
struct ColliderDescription {
    std::string name;
    std::variant<PlaneShape, MeshShape> shape;
    std::uint32_t material = 0;  ///< index into the simulation's materials
};

}  // namespace ricochet
