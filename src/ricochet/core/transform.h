/// \file
/// Placement of a collider or emitter in the world: scale, then rotate, then translate.
#pragma once

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Transform of a local shape into the world, in the terms of a scene file.
struct Placement {
    Vec3 position;                  ///< in m
    Vec3 rotation_axis{0, 0, 1};    ///< need not be of unit length; not zero
    double rotation_degrees = 0.0;  ///< right-hand rule about rotation_axis
    Vec3 scale{1, 1, 1};            ///< per axis, not zero; a negative factor mirrors
};

/// An affine map x -> M x + t. Names of maps give the direction: `world_from_local` maps local coordinates to the
/// world.
struct AffineMap {
    Vec3 row_x{1, 0, 0};
    Vec3 row_y{0, 1, 0};
    Vec3 row_z{0, 0, 1};
    Vec3 translation;

    [[nodiscard]] Vec3 point(const Vec3& p) const { return direction(p) + translation; }
    [[nodiscard]] Vec3 direction(const Vec3& d) const { return {dot(row_x, d), dot(row_y, d), dot(row_z, d)}; }
    /// Applies the inverse of the linear part, which must be a rotation. Sums over the rows in their order.
    [[nodiscard]] Vec3 direction_back(const Vec3& d) const { return d.x * row_x + d.y * row_y + d.z * row_z; }
    [[nodiscard]] double determinant() const { return dot(row_x, cross(row_y, row_z)); }
    /// Returns true if the map mirrors, so that triangle windings must be flipped.
    [[nodiscard]] bool mirrors() const { return determinant() < 0.0; }

    /// Saves or restores the map. a: an archive, which is called with each member.
    template <class Archive>
    void archive(Archive& a) {
        a(row_x), a(row_y), a(row_z), a(translation);
    }
};

/// Returns the map of a placement. Throws InputError for numbers that are not finite and an axis without length.
/// Multiples of 90 degrees about a coordinate axis are exact.
[[nodiscard]] AffineMap world_from_local(const Placement& placement);

}  // namespace ricochet
