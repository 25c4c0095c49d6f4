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

/// Returns one line for each probable mistake. The line contains the path in the scene, the finding and a remedy. The
/// warnings cover:
/// - particles that start on both sides of a closed collider, or inside a leaking collider;
/// - emitted spheres that find no free position, or do not fit through the opening below them;
/// - spheres too small for the precision of their coordinates;
/// - meshes without area;
/// - steps in which particles fall through the whole scene;
/// - settings for collisions in scenes without surfaces.
/// The function samples a few hundred start positions of every emitter and a few thousand explicit particles. A scene
/// without warnings can still contain mistakes.
/// simulation: a simulation before its first step.
/// emitters: emitters of the setup that the simulation was built from.
/// fall: uniform acceleration, in m/s^2 (uniform_acceleration()).
[[nodiscard]] std::vector<std::string> scene_warnings(const Simulation& simulation,
                                                      std::span<const EmitterDescription> emitters, const Vec3& fall);

/// Returns the warnings about the method of particle contacts. Every run prints these warnings too, because they need
/// only the options.
[[nodiscard]] std::vector<std::string> pair_method_warnings(const Simulation& simulation, const Vec3& fall);

/// Warns about a time step in which a free fall from rest covers more than the scene's diagonal. Returns nothing if the
/// size is unknown.
[[nodiscard]] std::optional<std::string> long_step_warning(const SimulationOptions& options, const Box3& scene,
                                                           const Vec3& fall);

/// Returns one line for each emitter whose particles start outside the setup's bounds. Every run prints these lines
/// too. Throws InputError for shapes with values out of range, as the simulation does.
[[nodiscard]] std::vector<std::string> bounds_warnings(const SimulationSetup& setup);

// Parts of scene_warnings().

/// Warns about a sphere that is too small for the precision of its coordinates.
[[nodiscard]] std::optional<std::string> small_radius_warning(const std::string& where,
                                                              std::span<const Particle> starts);

/// Warns about start positions so far from the colliders that a wrong unit of length is likely.
/// surfaces: box of all colliders, in m. path: longest distance that particles could fly in the run without forces, in
/// m.
[[nodiscard]] std::optional<std::string> far_starts_warning(const std::string& where, std::span<const Particle> starts,
                                                            const Box3& surfaces, double path);

/// Number of sampled starts of each emitter.
inline constexpr std::size_t kDrawnStarts = 256;

/// Samples start states of an emitter's particles. The samples differ from the particles of the run.
[[nodiscard]] std::vector<Particle> drawn_starts(const EmitterDescription& emitter, std::size_t index,
                                                 std::size_t count);

/// Returns the path of a list entry in the scene, followed by the entry's name if it has one. Example: emitters[0]
/// 'rain'.
[[nodiscard]] std::string name_in_list(std::string_view list, std::size_t index, const std::string& name);

}  // namespace ricochet
