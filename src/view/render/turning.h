/// \file
/// Rotations of drawn particles, and stretching at constant volume.
#pragma once

#include <cstdint>

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Rotation as a unit quaternion.
struct Turn {
    double w = 1.0;
    Vec3 v;
};

/// Returns a random rotation for the particle with the given id, uniformly distributed over all rotations. It is the
/// same in every run and on every machine.
/// Method: K. Shoemake, "Uniform Random Rotations", Graphics Gems III, 1992.
[[nodiscard]] Turn random_turn(std::uint64_t id);
/// Returns the rotation after some seconds at a constant spin, in rad/s.
[[nodiscard]] Turn rotation_after(const Turn& turn, const Vec3& spin, double seconds);
/// Returns a rotation as a map without translation.
[[nodiscard]] AffineMap map_of(const Turn& turn);

/// Random parameters of one particle, determined by its id like random_turn().
struct ParticleTurning {
    Vec3 axis;            ///< of unit length
    double angle = 0.0;   ///< radians, in [0, 2 pi)
    double spread = 0.0;  ///< random number in [-1, 1)
};
[[nodiscard]] ParticleTurning particle_turning(std::uint64_t id);

/// Returns a map that multiplies lengths along a unit direction by a factor > 0. It divides lengths perpendicular to
/// the direction by the square root of the factor, so that the volume stays constant.
[[nodiscard]] AffineMap stretch_along(const Vec3& direction, double factor);
/// Returns the composition of two maps without translations. `before` is applied first.
[[nodiscard]] AffineMap linear_product(const AffineMap& after, const AffineMap& before);

}  // namespace ricochet
