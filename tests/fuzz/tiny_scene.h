/// \file Scenes of a few particles and colliders, selected by a fuzzer's bytes.
#pragma once

#include <cstddef>

#include "fuzz/byte_choices.h"
#include "ricochet/simulation.h"

namespace ricochet::fuzz {

/// Number of steps of a tiny scene.
inline constexpr std::size_t kTinySteps = 5;

/// Returns a scene some metres wide. The bytes select mesh, shape, placement, material, emitter, force, flow,
/// integrator, response and radius. The same bytes give the same scene. Simulation may refuse the scene.
[[nodiscard]] SimulationSetup tiny_scene(ByteChoices choices);

}  // namespace ricochet::fuzz
