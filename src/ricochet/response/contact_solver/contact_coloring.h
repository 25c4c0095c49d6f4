/// \file
/// Private to the responses: contacts in an order in which threads can work on them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/response/contact_solver/contact_network.h"

namespace ricochet {

/// Contacts in groups ("colours") of which no two have a body in common, so that those of a group can be worked on in
/// any order with the same result. Contacts get the first colour that is free at both bodies, in their order, so that
/// it depends on that alone. Bodies with more contacts than kMostColors leave some over, which are a last group, to be
/// worked off by one thread in order.
class ContactColoring {
public:
    static constexpr std::uint32_t kMostColors = 64;

    /// bodies: how many there are.
    void assign(std::size_t bodies, std::span<const SolverContact> contacts);

    [[nodiscard]] std::size_t colors() const { return ends_.size(); }
    /// Contacts, ascending, of a colour.
    [[nodiscard]] std::size_t begin_of(std::size_t color) const { return color == 0 ? 0 : ends_[color - 1]; }
    [[nodiscard]] std::size_t end_of(std::size_t color) const { return ends_[color]; }
    /// All contacts, colour by colour.
    [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }
    /// True for the last group where contacts were left over: they have bodies in common.
    [[nodiscard]] bool is_serial(std::size_t color) const { return has_rest_ && color + 1 == ends_.size(); }

private:
    std::vector<std::uint64_t> used_;  // colours, of each body
    std::vector<std::uint8_t> color_;  // of each contact
    std::vector<std::uint32_t> order_;
    std::vector<std::size_t> ends_;
    bool has_rest_ = false;
};

}  // namespace ricochet
