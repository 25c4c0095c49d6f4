/// \file Small random scenes that cover the features of a run: every response, integrator, shape and material.
#pragma once

#include <cstdint>
#include <string>

namespace ricochet::golden {

/// Number of different scenes.
inline constexpr int kRandomScenes = 96;

/// Bounce budget of the random scenes. It is small, so that some particles exhaust it.
inline constexpr std::uint32_t kRandomSceneBudget = 200;

/// Returns the text of scene `number` (0 .. kRandomScenes - 1), which is the same on every system. The number is also
/// the seed. Its residues select the features to combine. Mesh files are named relative to the repository's scenes
/// folder.
[[nodiscard]] std::string random_scene(int number);

}  // namespace ricochet::golden
