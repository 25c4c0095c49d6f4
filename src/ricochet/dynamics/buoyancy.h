/// \file
/// Lift of particles in a fluid at rest under gravity.
#pragma once

#include <memory>

#include "ricochet/dynamics/force.h"

namespace ricochet {

/// Archimedes's F = -fluid_density (4/3) pi radius^3 gravity for the particle's own radius: none for points. The
/// particle's own weight is a force of its own (make_gravity). fluid_density in kg/m^3, >= 0; gravity in m/s^2.
[[nodiscard]] std::unique_ptr<Force> make_buoyancy(double fluid_density, const Vec3& gravity);

}  // namespace ricochet
