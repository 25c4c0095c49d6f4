/// \file Random scenes for persistent contact. A scene has a closed room of any kind with bodies in it, spheres of
/// mixed sizes, points, and uniform gravity.
#pragma once

#include <cstdint>

#include "ricochet/simulation.h"

namespace ricochet::testing {

/// Returns the scene of a seed, which is the same on every system. At the start, no particle overlaps a surface, and
/// some particles touch one.
[[nodiscard]] SimulationSetup random_contact_scene(std::uint64_t seed);

/// Returns the uniform acceleration of the scene, in m/s^2.
[[nodiscard]] Vec3 random_contact_gravity(std::uint64_t seed);

}  // namespace ricochet::testing
