/// \file
/// How drawn particles are turned, and how they change their shape at the same volume.
#pragma once

#include <cstdint>

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// A turn as a unit quaternion.
struct Turn {
    double w = 1.0;
    Vec3 v;
};

/// One for each particle, uniform over all turns, the same in every run and on every machine.
/// Method: K. Shoemake, "Uniform Random Rotations", Graphics Gems III, 1992.
[[nodiscard]] Turn random_turn(std::uint64_t id);
/// After turning on at a constant spin, rad/s.
[[nodiscard]] Turn turned_on(const Turn& turn, const Vec3& spin, double seconds);
/// The turn as a map, without translation.
[[nodiscard]] AffineMap map_of(const Turn& turn);

/// What is a particle's own, as random_turn() is.
struct OwnTurning {
    Vec3 axis;            ///< of unit length
    double angle = 0.0;   ///< radians, in [0, 2 pi)
    double spread = 0.0;  ///< in [-1, 1)
};
[[nodiscard]] OwnTurning own_turning(std::uint64_t id);

/// Makes things longer along a unit direction by a factor > 0, and thinner across it by its square root: the volume
/// stays.
[[nodiscard]] AffineMap stretch_along(const Vec3& direction, double factor);
/// First `before`, then `after`; without translations.
[[nodiscard]] AffineMap linear_product(const AffineMap& after, const AffineMap& before);

}  // namespace ricochet
