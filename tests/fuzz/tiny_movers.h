/// \file Moving colliders of a tiny scene, from a fuzzer's bytes.
#pragma once

#include "fuzz/byte_choices.h"
#include "ricochet/simulation.h"

namespace ricochet::fuzz {

/// Adds moving frames, driven bodies, deforming meshes, moving materials and collisions between spheres, as the bytes
/// select. All of them are optional.
void add_movers(ByteChoices& choices, SimulationSetup& setup);

}  // namespace ricochet::fuzz
