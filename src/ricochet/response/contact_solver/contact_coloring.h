/// \file
/// An order of contacts in which several threads can solve them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/response/contact_solver/contact_network.h"

namespace ricochet {

/// Graph colouring of contacts. No two contacts of a colour share a body, so they can be solved in any order with the
/// same result. Each contact in turn gets the first colour that is free at both bodies. If a body has more contacts
/// than there are colours, the others form a last group, which one thread solves in order.
class ContactColoring {
public:
    static constexpr std::uint32_t kMostColors = 64;

    /// Colours the contacts of a number of bodies.
    void assign(std::size_t bodies, std::span<const SolverContact> contacts);

    [[nodiscard]] std::size_t colors() const { return ends_.size(); }
    /// Range of a colour in order(). Contacts of a colour are in ascending order.
    [[nodiscard]] std::size_t begin_of(std::size_t color) const { return color == 0 ? 0 : ends_[color - 1]; }
    [[nodiscard]] std::size_t end_of(std::size_t color) const { return ends_[color]; }
    /// Returns all contacts, sorted by colour.
    [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }
    /// Returns true for the last group if its contacts have no colour, because they may share bodies.
    [[nodiscard]] bool is_serial(std::size_t color) const { return has_rest_ && color + 1 == ends_.size(); }

private:
    std::vector<std::uint64_t> used_;  // used colours of each body, as bits
    std::vector<std::uint8_t> color_;  // colour of each contact
    std::vector<std::uint32_t> order_;
    std::vector<std::size_t> ends_;
    bool has_rest_ = false;
};

}  // namespace ricochet
