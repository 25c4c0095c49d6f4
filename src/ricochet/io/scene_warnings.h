/// \file
/// What is probably not meant in a scene that can be run: `ricochet check` says so, and `run` a part of it.
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

/// One line each: where, what, what to do about it. About particles that begin on both sides of a closed collider or
/// inside one that leaks, spheres that find no position, do not fit through the opening that they fall to or are too
/// small for their coordinates, meshes without area, steps
/// in which all falls through the whole scene, and collisions that are asked for where there is nothing to hit. What is
/// said rests on some hundred starts of every emitter and some thousand of the explicit particles; a scene without a
/// line here may still be wrong. simulation: before its first step. emitters: of the setup that it was made from. fall:
/// m/s^2, the acceleration that is the same everywhere (uniform_acceleration()).
[[nodiscard]] std::vector<std::string> scene_warnings(const Simulation& simulation,
                                                      std::span<const EmitterDescription> emitters, const Vec3& fall);

/// Those of them about the method of particle contacts, which depends on little and is told with every run, too.
[[nodiscard]] std::vector<std::string> pair_method_warnings(const Simulation& simulation, const Vec3& fall);

/// A step in which what falls from rest falls further than all of the scene is large. Nothing where that is unknown.
[[nodiscard]] std::optional<std::string> long_step_warning(const SimulationOptions& options, const Box3& scene,
                                                           const Vec3& fall);

/// Emitters whose particles begin outside the setup's bounds, a line each. Told with every run, too. Throws InputError
/// for shapes out of range, as the simulation does.
[[nodiscard]] std::vector<std::string> bounds_warnings(const SimulationSetup& setup);

// Parts of these reviews.

/// Warns of a sphere that is too small for the precision of its coordinates.
[[nodiscard]] std::optional<std::string> small_radius_warning(const std::string& where,
                                                              std::span<const Particle> starts);

/// Warns of starts at a distance from the colliders that only a wrong unit explains. surfaces: the box of all colliders
/// but planes, in m.
[[nodiscard]] std::optional<std::string> far_starts_warning(const std::string& where, std::span<const Particle> starts,
                                                            const Box3& surfaces);

/// Starts of an emitter that are looked at.
inline constexpr std::size_t kDrawnStarts = 256;

/// Draws starts of an emitter, which are not those of the run.
[[nodiscard]] std::vector<Particle> drawn_starts(const EmitterDescription& emitter, std::size_t index,
                                                 std::size_t count);

/// Returns an entry's path in the scene, with its name if it has one: emitters[0] 'rain'.
[[nodiscard]] std::string name_in_list(std::string_view list, std::size_t index, const std::string& name);

}  // namespace ricochet
