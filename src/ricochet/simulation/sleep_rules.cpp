#include "ricochet/simulation/sleep_rules.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ricochet {
namespace {

/// Steps that a sphere, and all that press on it, lie still before it sleeps: what begins to move on a slope has gone
/// farther by then.
constexpr std::uint32_t kStepsToSleep = 50;

/// Parts of the radius that what lies still may move in a step; and in islands beside colliders that move, which may
/// carry it slowly.
constexpr double kStillWay = 4e-5;
constexpr double kStillWayBesideMovers = 1e-5;

/// It is no faster than such a part of what a fall of its radius makes, for such a part of the time that this fall
/// takes: what begins to move with a hundredth of the pull is faster by then, however short steps are.
constexpr double kStillSpeed = 1e-3;
constexpr double kStillTime = 0.1;

/// m/s, of its surface where it is fastest.
double speed_of(const ContactIslandMember& member, const SolverBody& planned) {
    return length(planned.velocity) + member.radius * length(planned.spin);
}

}  // namespace

bool is_slow(const ContactIslandMember& member, const SolverBody& planned, bool beside_movers) {
    const double distance = beside_movers ? kStillWayBesideMovers : kStillWay;
    return member.duration * speed_of(member, planned) < distance * member.radius;
}

bool is_at_rest(const ContactIslandMember& member, const SolverBody& planned, double pull) {
    return !(pull > 0.0) || speed_of(member, planned) <= kStillSpeed * std::sqrt(pull * member.radius);
}

std::uint32_t steps_to_sleep(const ContactIslandMember& member, double pull) {
    const double time = pull > 0.0 ? kStillTime * std::sqrt(member.radius / pull) : 0.0;
    const double steps = std::min(std::ceil(time / member.duration), 1e9);
    return std::max(kStepsToSleep, static_cast<std::uint32_t>(steps));
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
