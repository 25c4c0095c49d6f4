#include "ricochet/simulation/sleep_rules.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
