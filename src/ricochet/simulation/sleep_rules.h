/// \file
/// Private to the simulation: when spheres of dense islands lie still, and so long that they fall asleep.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/response/contact_solver/contact_island.h"

namespace ricochet {

/// A member hardly moves in a step as it is planned, whatever pulls it. beside_movers: colliders that move are near its
/// island, which they may carry.
[[nodiscard]] bool is_slow(const ContactIslandMember& member, const SolverBody& planned, bool beside_movers);
/// One that is slow does so for what pulls it, too. pull: m/s^2, of the forces on it.
[[nodiscard]] bool is_at_rest(const ContactIslandMember& member, const SolverBody& planned, double pull);
/// Steps that it has to lie still before it sleeps.
[[nodiscard]] std::uint32_t steps_to_sleep(const ContactIslandMember& member, double pull);

/// Leaves of those that would fall asleep those that are held, or rest on such: one that lies on others that
/// stay awake would weigh on nobody. is_held: of each. pressing: members that press on each other, by their numbers.
void keep_supported(std::vector<std::uint8_t>& falls, const std::vector<std::uint8_t>& is_held,
                    std::span<const NeighbourPair> pressing);

}  // namespace ricochet
