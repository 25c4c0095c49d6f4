#include "ricochet/response/contact_solver/connected_impacts.h"

#include "ricochet/core/disjoint_sets.h"

namespace ricochet {

// The smallest number represents each set, so one pass in ascending order finds all roots.
void ConnectedImpacts::assign(std::span<const SolverState> states, std::span<const ContactConstraint> rows) {
    DisjointSets sets(states.size());
    fixed_.resize(states.size());
    for (std::size_t i = 0; i < states.size(); ++i) fixed_[i] = states[i].inverse_mass == 0.0 ? 1 : 0;
    for (const ContactConstraint& row : rows) {
        if (row.impulse.normal == 0.0 || is_fixed(row.a) || is_fixed(row.b)) continue;
        sets.join(row.a, row.b);
    }
    leaders_.resize(states.size());
    for (std::uint32_t i = 0; i < leaders_.size(); ++i) leaders_[i] = sets.find(i);
}

}  // namespace ricochet
