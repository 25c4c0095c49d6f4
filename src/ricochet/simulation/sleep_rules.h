/// \file
/// Private to the simulation: the rules by which spheres of contact islands are at rest and fall asleep.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/response/contact_solver/contact_island.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/query_schedule.h"

namespace ricochet {

/// Returns true if a member hardly moves in its planned step, whatever the forces on it. beside_movers: moving
/// colliders are near its island, and may carry it.
[[nodiscard]] bool is_slow(const ContactIslandMember& member, const SolverBody& planned, bool beside_movers);
/// Returns true if a slow member is also slow for the forces on it. pull: their acceleration, in m/s^2.
[[nodiscard]] bool is_at_rest(const ContactIslandMember& member, const SolverBody& planned, double pull);
/// Returns the number of steps that a member must be at rest before it sleeps.
[[nodiscard]] std::uint32_t steps_to_sleep(const ContactIslandMember& member, double pull);

/// Returns true if a member lives through the whole step, and no moving collider is near.
[[nodiscard]] bool may_sleep(const ResponseRules& rules, const ContactIslandMember& member, const TimeSpan& step);
/// Returns true if a moving collider may touch a sphere at this position in the step.
[[nodiscard]] bool is_beside_movers(const ResponseRules& rules, const Vec3& center, double radius);
/// Returns true if a driven material, such as a belt, pushes a member. Such a push does not end.
[[nodiscard]] bool is_carried_by_material(const ResponseRules& rules, const ContactIsland& island, std::size_t index);
[[nodiscard]] bool is_supported_by_surfaces(const ResponseRules& rules, const ContactIslandMember& member,
                                            const ContactIsland& island, std::size_t index);
/// Returns true if a surface supports a sphere against the acceleration by forces with the impulse that it gives the
/// sphere. A surface with friction always can.
[[nodiscard]] bool holds(const ResponseRules& rules, SurfaceId surface, const Vec3& wall_impulse, const Vec3& pull);

/// Keeps, of the members that would fall asleep, those with a support and others that rest on them. A member that rests
/// on spheres that stay awake would press on none of them. is_held: flags of supported members. pressing: pairs of
/// members that press on each other, by their numbers.
void keep_supported(std::vector<std::uint8_t>& falls, const std::vector<std::uint8_t>& is_held,
                    std::span<const NeighbourPair> pressing);

}  // namespace ricochet
