/// \file
/// What moves beside the particles of a tiny scene, from a fuzzer's bytes.
#pragma once

#include "fuzz/byte_choices.h"
#include "ricochet/simulation.h"

namespace ricochet::fuzz {

/// Puts colliders into frames that move, bodies that are pushed and meshes that deform, lets materials run, and spheres
/// meet: all or nothing of that, as the bytes say.
void add_movers(ByteChoices& choices, SimulationSetup& setup);

}  // namespace ricochet::fuzz
