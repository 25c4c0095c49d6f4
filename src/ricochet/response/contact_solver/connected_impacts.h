/// \file
/// Private to the solver of contact networks: which contacts belong to one impact, and what holds for each impact as a
/// whole: its restitution and its energy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/response/contact_solver/contact_constraints.h"

namespace ricochet {

/// Bodies joined by contacts that push.
class ConnectedImpacts {
public:
    /// Those of the rows whose impulse is not 0. states: of all bodies and walls; what nothing moves joins nothing.
    void assign(std::span<const SolverState> states, std::span<const ContactConstraint> rows);

    /// Of a row: a number below the number of states that stands for its impact.
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
