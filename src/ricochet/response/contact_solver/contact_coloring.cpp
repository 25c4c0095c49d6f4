#include "ricochet/response/contact_solver/contact_coloring.h"

#include <array>
#include <bit>

namespace ricochet {

void ContactColoring::assign(std::size_t bodies, std::span<const SolverContact> contacts) {
    used_.assign(bodies, 0);
    color_.resize(contacts.size());
    std::array<std::size_t, kMostColors + 1> counts{};
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        const SolverContact& contact = contacts[i];
        const bool is_pair = contact.b != SolverContact::kWall;
        const std::uint64_t taken = used_[contact.a] | (is_pair ? used_[contact.b] : 0);
        const auto color = static_cast<std::uint32_t>(std::countr_one(taken));  // kMostColors: none is free
        if (color < kMostColors) {
            used_[contact.a] |= std::uint64_t{1} << color;
            if (is_pair) used_[contact.b] |= std::uint64_t{1} << color;
        }
        color_[i] = static_cast<std::uint8_t>(color);
        ++counts[color];
    }
    has_rest_ = counts[kMostColors] > 0;
    std::array<std::size_t, kMostColors + 1> next{};
    ends_.clear();
    std::size_t end = 0;
    for (std::size_t color = 0; color < counts.size(); ++color) {
        next[color] = end;
        end += counts[color];
        if (counts[color] > 0) ends_.push_back(end);
    }
    order_.resize(contacts.size());
    for (std::size_t i = 0; i < contacts.size(); ++i) order_[next[color_[i]]++] = static_cast<std::uint32_t>(i);
}

}  // namespace ricochet
