#include "ricochet/simulation/counters/visits.h"

#include <algorithm>
#include <cmath>

namespace ricochet {

bool Visits::pass(std::uint64_t particle) {
    const auto word = static_cast<std::size_t>(particle / 64U);
    const std::uint64_t bit = std::uint64_t{1} << (particle % 64U);
    if (word >= passed_.size()) passed_.resize(word + 1);
    const bool is_first = (passed_[word] & bit) == 0;
    passed_[word] |= bit;
    return is_first;
}

std::optional<double> Visits::leave(std::uint64_t particle) {
    const auto entry = entered_.find(particle);
    if (entry == entered_.end()) return std::nullopt;
    const double time = entry->second;
    entered_.erase(entry);
    return time;
}

bool Visits::is_sound() const {
    return std::ranges::all_of(entered_, [](const auto& entry) { return std::isfinite(entry.second); });
}

}  // namespace ricochet
