/// \file
/// Warnings about probable mistakes in a valid scene. `ricochet check` prints all of them, and `run` prints a part.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/dynamics/emitter.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// Returns one line for each probable mistake, with source, finding and remedy. The warnings cover:
/// - particles that begin on both sides of a closed collider, or inside one that leaks;
/// - spheres that find no position, or do not fit through the opening below them;
/// - spheres too small for the precision of their coordinates;
/// - meshes without area;
/// - steps in which particles fall through the whole scene;
/// - settings for collisions in scenes without surfaces.
/// The review samples some hundred starts of every emitter and some thousand explicit particles. A scene without
/// warnings may still be wrong.
/// simulation: before its first step. emitters: of the setup that the simulation was built from. fall: uniform
/// acceleration, in m/s^2 (uniform_acceleration()).
[[nodiscard]] std::vector<std::string> scene_warnings(const Simulation& simulation,
                                                      std::span<const EmitterDescription> emitters, const Vec3& fall);

/// Returns the warnings about the method of particle contacts. They need only the options, so every run prints them
/// too.
[[nodiscard]] std::vector<std::string> pair_method_warnings(const Simulation& simulation, const Vec3& fall);

/// Warns of a step in which a free fall from rest is longer than the scene's diagonal. Returns nothing if the size is
/// unknown.
[[nodiscard]] std::optional<std::string> long_step_warning(const SimulationOptions& options, const Box3& scene,
                                                           const Vec3& fall);

/// Returns one line for each emitter whose particles begin outside the setup's bounds; every run prints them too.
/// Throws InputError for shapes out of range, as the simulation does.
[[nodiscard]] std::vector<std::string> bounds_warnings(const SimulationSetup& setup);

// Parts of the review.

/// Warns of a sphere too small for the precision of its coordinates.
[[nodiscard]] std::optional<std::string> small_radius_warning(const std::string& where,
                                                              std::span<const Particle> starts);

/// Warns of starts so far from the colliders that a wrong unit is likely.
/// surfaces: box of all colliders. path: farthest distance that particles fly in the run without forces. Both in m.
[[nodiscard]] std::optional<std::string> far_starts_warning(const std::string& where, std::span<const Particle> starts,
                                                            const Box3& surfaces, double path);

/// Number of sampled starts of each emitter.
inline constexpr std::size_t kDrawnStarts = 256;

/// Samples starts of an emitter. They differ from the starts of the run.
[[nodiscard]] std::vector<Particle> drawn_starts(const EmitterDescription& emitter, std::size_t index,
                                                 std::size_t count);

/// Returns an entry's path in the scene, with its name if it has one, such as emitters[0] 'rain'.
[[nodiscard]] std::string name_in_list(std::string_view list, std::size_t index, const std::string& name);

}  // namespace ricochet
