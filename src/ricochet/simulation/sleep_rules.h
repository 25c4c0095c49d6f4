/// \file
/// Private to the simulation: rules that decide whether spheres of contact islands are at rest and fall asleep.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/response/contact_solver/contact_island.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/query_schedule.h"

namespace ricochet {

/// Returns true if a member moves only by a small part of its radius in its planned step. Forces on the member do not
/// matter. beside_movers: true if moving colliders are near the island and may carry its members.
[[nodiscard]] bool is_slow(const ContactIslandMember& member, const SolverBody& planned, bool beside_movers);
/// Returns true if a slow member is also slow compared with the acceleration by forces on it, `pull`, in m/s^2.
[[nodiscard]] bool is_at_rest(const ContactIslandMember& member, const SolverBody& planned, double pull);
/// Returns the number of steps that a member must be at rest before it sleeps.
[[nodiscard]] std::uint32_t steps_to_sleep(const ContactIslandMember& member, double pull);

/// Returns true if a member moves through the whole step, without forces of other particles or a moving collider near.
[[nodiscard]] bool may_sleep(const ResponseRules& rules, const ContactIslandMember& member, const TimeSpan& step);
/// Returns true if a moving collider may touch a sphere at this position in the step.
[[nodiscard]] bool is_beside_movers(const ResponseRules& rules, const Vec3& center, double radius);
/// Returns true if a driven material, such as a conveyor belt, pushes a member. Such a push never ends.
[[nodiscard]] bool is_carried_by_material(const ResponseRules& rules, const ContactIsland& island, std::size_t index);
[[nodiscard]] bool is_supported_by_surfaces(const ResponseRules& rules, const ContactIslandMember& member,
                                            const ContactIsland& island, std::size_t index);
/// Returns true if a surface supports a sphere against the acceleration `pull` by forces. wall_impulse: impulse of the
/// surface on the sphere. A surface with friction always supports the sphere.
[[nodiscard]] bool holds(const ResponseRules& rules, SurfaceId surface, const Vec3& wall_impulse, const Vec3& pull);

/// Limits the members that fall asleep. A row of pressing contacts must connect each of them to a supported member. A
/// sleeping member that rested only on awake spheres would no longer press on them. is_held: flags of supported
/// members. pressing: pairs of numbers of members that press on each other.
void keep_supported(std::vector<std::uint8_t>& falls, const std::vector<std::uint8_t>& is_held,
                    std::span<const NeighbourPair> pressing);

}  // namespace ricochet
