/// \file
/// Scenes of a few particles and colliders that a fuzzer's bytes choose.
#pragma once

#include <cstddef>

#include "fuzz/byte_choices.h"
#include "ricochet/simulation.h"

namespace ricochet::fuzz {

/// Steps of a tiny scene.
inline constexpr std::size_t kTinySteps = 5;

/// Every mesh, shape, placement, material, emitter, force, flow, integrator, response and radius that bytes can choose,
/// in scenes some metres wide. The same bytes make the same scene. May be one that Simulation refuses.
[[nodiscard]] SimulationSetup tiny_scene(ByteChoices choices);

}  // namespace ricochet::fuzz
