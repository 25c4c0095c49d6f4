/// \file
/// Private to the simulation: the rules by which spheres of contact islands are at rest and fall asleep.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/response/contact_solver/contact_island.h"

namespace ricochet {

/// Returns true if a member hardly moves in its planned step, whatever the forces on it. beside_movers: moving
/// colliders are near its island, and may carry it.
[[nodiscard]] bool is_slow(const ContactIslandMember& member, const SolverBody& planned, bool beside_movers);
/// Returns true if a slow member is also slow for the forces on it. pull: their acceleration, in m/s^2.
[[nodiscard]] bool is_at_rest(const ContactIslandMember& member, const SolverBody& planned, double pull);
/// Returns the number of steps that a member must be at rest before it sleeps.
[[nodiscard]] std::uint32_t steps_to_sleep(const ContactIslandMember& member, double pull);

/// Keeps, of the members that would fall asleep, those with a support and others that rest on them. A member that rests
/// on spheres that stay awake would press on none of them. is_held: flags of supported members. pressing: pairs of
/// members that press on each other, by their numbers.
void keep_supported(std::vector<std::uint8_t>& falls, const std::vector<std::uint8_t>& is_held,
                    std::span<const NeighbourPair> pressing);

}  // namespace ricochet
