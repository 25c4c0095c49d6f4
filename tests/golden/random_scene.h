/// \file
/// Small random scenes that cover what a run can do: every response, integrator, shape and material.
#pragma once

#include <cstdint>
#include <string>

namespace ricochet::golden {

/// Number of different scenes.
inline constexpr int kRandomScenes = 96;

/// Their budget of bounces: small, so that some spend it.
inline constexpr std::uint32_t kRandomSceneBudget = 200;

/// The text of scene `number` (0 .. kRandomScenes - 1): the same on every system. The number also is the seed; its
/// residues decide which features are combined. Mesh files are named relative to the repository's scenes folder.
[[nodiscard]] std::string random_scene(int number);

}  // namespace ricochet::golden
