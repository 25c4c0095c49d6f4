/// \file
/// Private to the contact solver: groups of contacts that form one connected impact. Each group has one restitution and
/// one energy balance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/response/contact_solver/contact_constraints.h"

namespace ricochet {

/// Sets of bodies that are joined by contacts with an impulse.
class ConnectedImpacts {
public:
    /// Joins the bodies of every row with a normal impulse. `states` contains all bodies and walls. Fixed bodies and
    /// walls join nothing.
    void assign(std::span<const SolverState> states, std::span<const ContactConstraint> rows);

    /// Returns the number of a row's impact, which is less than size().
    [[nodiscard]] std::uint32_t of(const ContactConstraint& row) const {
        return of_body(is_fixed(row.a) ? row.b : row.a);
    }
    [[nodiscard]] std::uint32_t of_body(std::uint32_t body) const { return leaders_[body]; }
    [[nodiscard]] std::size_t size() const { return leaders_.size(); }

private:
    [[nodiscard]] bool is_fixed(std::uint32_t body) const { return fixed_[body] != 0; }

    std::vector<std::uint32_t> leaders_;
    std::vector<std::uint8_t> fixed_;
};

}  // namespace ricochet
