#include "ricochet/simulation/sleep_rules.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Returns the largest speed of a member's surface, in m/s.
double speed_of(const ContactIslandMember& member, const SolverBody& planned) {
    return length(planned.velocity) + member.radius * length(planned.spin);
}

}  // namespace

bool is_slow(const ContactIslandMember& member, const SolverBody& planned, bool beside_movers) {
    const double distance = beside_movers ? kRestingPathBesideMovers : kRestingPath;
    return member.duration * speed_of(member, planned) < distance * member.radius;
}

bool is_at_rest(const ContactIslandMember& member, const SolverBody& planned, double pull) {
    return !(pull > 0.0) || speed_of(member, planned) <= kRestingSpeed * std::sqrt(pull * member.radius);
}

std::uint32_t steps_to_sleep(const ContactIslandMember& member, double pull) {
    const double time = pull > 0.0 ? kRestingTime * std::sqrt(member.radius / pull) : 0.0;
    const double steps = std::min(std::ceil(time / member.duration), 1e9);  // fits into 32 bits
    return std::max(kStepsToSleep, static_cast<std::uint32_t>(steps));
}

bool is_carried_by_material(const ResponseRules& rules, const ContactIsland& island, std::size_t index) {
    const std::vector<WallImpulse> impulses = island.impulses_of(index);
    return std::ranges::any_of(impulses, [&](const WallImpulse& wall_impulse) {
        return rules.materials[rules.world.material_of(wall_impulse.surface)].drives();
    });
}

bool is_supported_by_surfaces(const ResponseRules& rules, const ContactIslandMember& member,
                              const ContactIsland& island, std::size_t index) {
    const std::vector<WallImpulse> impulses = island.impulses_of(index);
    const Vec3 pull = rules.forces.acceleration(member.moving->state);
    return std::ranges::any_of(impulses, [&](const WallImpulse& wall_impulse) {
        return holds(rules, wall_impulse.surface, wall_impulse.velocity_change, pull);
    });
}

bool holds(const ResponseRules& rules, SurfaceId surface, const Vec3& wall_impulse, const Vec3& pull) {
    const bool rubs = rules.materials[rules.world.material_of(surface)].friction > 0.0;
    return rubs || pull == Vec3{} || -dot(wall_impulse, pull) > kSupportingCosine * length(wall_impulse) * length(pull);
}

bool may_sleep(const ResponseRules& rules, const ContactIslandMember& member, const TimeSpan& step) {
    const bool is_acted_on = member.moving->state.coupling != nullptr;  // by other particles, which may move
    const bool is_moved = !member.is_fixed && !member.is_pinched && member.duration == step.end - step.begin;
    if (is_acted_on || !is_moved) return false;
    return !is_beside_movers(rules, member.moving->state.position, member.radius);
}

bool is_beside_movers(const ResponseRules& rules, const Vec3& center, double radius) {
    return !rules.bodies.all_stay_out(ball_box(center, (1.0 + kWakingFall) * radius));
}

void keep_supported(std::vector<std::uint8_t>& falls, const std::vector<std::uint8_t>& is_held,
                    std::span<const NeighbourPair> pressing) {
    std::vector<std::vector<std::size_t>> touching(falls.size());
    for (const auto& [a, b] : pressing) {
        if (falls[a] == 0 || falls[b] == 0) continue;
        touching[a].push_back(b);
        touching[b].push_back(a);
    }
    std::vector<std::uint8_t> held(falls.size(), 0);
    std::vector<std::size_t> open;
    const auto hold = [&](std::size_t i) {
        if (held[i] == 0) open.push_back(i);
        held[i] = 1;
    };
    for (std::size_t i = 0; i < falls.size(); ++i) {
        if (falls[i] != 0 && is_held[i] != 0) hold(i);
    }
    while (!open.empty()) {
        const std::size_t i = open.back();
        open.pop_back();
        for (const std::size_t next : touching[i]) hold(next);
    }
    falls = std::move(held);
}

}  // namespace ricochet
