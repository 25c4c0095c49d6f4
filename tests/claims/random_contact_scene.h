/// \file
/// Random scenes for contact that lasts: a closed room of any kind, bodies in it, spheres and points of mixed sizes,
/// uniform gravity.
#pragma once

#include <cstdint>

#include "ricochet/simulation.h"

namespace ricochet::testing {

/// The scene of a seed: the same on every system. Nothing overlaps at its start; some particles touch.
[[nodiscard]] SimulationSetup random_contact_scene(std::uint64_t seed);

/// Its uniform acceleration, m/s^2.
[[nodiscard]] Vec3 random_contact_gravity(std::uint64_t seed);

}  // namespace ricochet::testing
