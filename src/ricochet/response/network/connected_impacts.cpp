#include "ricochet/response/network/connected_impacts.h"

#include <algorithm>
#include <numeric>

namespace ricochet {

// The smallest number stands for the others, so that one pass in ascending order finds the roots of all.
void ConnectedImpacts::assign(std::span<const NetworkState> states, std::span<const NetworkRow> rows) {
    parents_.resize(states.size());
    std::iota(parents_.begin(), parents_.end(), 0U);
    fixed_.resize(states.size());
    for (std::size_t i = 0; i < states.size(); ++i) fixed_[i] = states[i].mobility == 0.0 ? 1 : 0;
    for (const NetworkRow& row : rows) {
        if (row.push.normal == 0.0 || is_fixed(row.a) || is_fixed(row.b)) continue;
        const std::uint32_t a = root_of(row.a);
        const std::uint32_t b = root_of(row.b);
        parents_[std::max(a, b)] = std::min(a, b);
    }
    for (std::uint32_t& parent : parents_) parent = parents_[parent];
}

std::uint32_t ConnectedImpacts::root_of(std::uint32_t body) {
    while (parents_[body] != body) {
        parents_[body] = parents_[parents_[body]];
        body = parents_[body];
    }
    return body;
}

}  // namespace ricochet
