/// \file
/// What an impact does to a velocity. Pure functions.
#pragma once

#include <span>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Velocity after an impact of a point with a fixed wall of unit normal n: the normal part is turned and scaled by the
/// restitution (Newton), the tangential part loses at most friction times the normal impulse per mass (Coulomb) and
/// never changes direction. A velocity that does not approach the wall (v . n >= 0) is returned unchanged. Without loss
/// (restitution 1, friction 0) the speed is kept to rounding, however often.
[[nodiscard]] Vec3 bounce(const Vec3& v, const Vec3& n, double restitution, double friction);

/// The vector closest to v among those that approach none of the planes (w . n_i >= 0 for all i). At most three planes
/// count.
[[nodiscard]] Vec3 project_off(const Vec3& v, std::span<const Vec3> normals);

}  // namespace ricochet
