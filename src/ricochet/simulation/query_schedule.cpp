#include "ricochet/simulation/query_schedule.h"

#include <utility>

namespace ricochet {

void QuerySchedule::begin_step(std::uint64_t step) {
    step_ = step;
    now_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(step + 1, kLeftAlone - 1));
}

void QuerySchedule::set_flying(std::size_t i, const FreeFlightForecast& forecast) {
    const double now = clock_.time_at(step_);
    const std::uint64_t step =
        forecast.free_until > now ? clock_.last_step_before(forecast.free_until, kLeftAlone - 2) : 0;
    const auto next = static_cast<std::uint32_t>(step + 1);
    set(i, next, candidates_for(next, forecast), forecast.clear);
}

// Returns the candidates of a forecast if they are complete for the whole step of the query. A last step that is not
// exactly whole gets no candidates, because rounding can make it longer.
ContactCandidates QuerySchedule::candidates_for(std::uint32_t next, const FreeFlightForecast& forecast) const {
    const std::uint64_t end = std::max<std::uint64_t>(next, step_ + 2);  // number of steps at the end of that step
    if (end >= clock_.steps() && !clock_.last_is_whole()) return {};
    return forecast.candidates_until >= clock_.time_at(end) ? forecast.candidates : ContactCandidates{};
}

void QuerySchedule::append(bool is_left_alone) {
    next_.push_back(is_left_alone ? kLeftAlone : kUnknown);
    candidates_.emplace_back();
    if (keeps_clear_spaces_) clear_.emplace_back();
}

void QuerySchedule::reserve(std::size_t more) {
    grow_capacity_by(next_, more);
    grow_capacity_by(candidates_, more);
    if (keeps_clear_spaces_) grow_capacity_by(clear_, more);
}

void QuerySchedule::compact(const std::vector<std::uint8_t>& keep) {
    keep_marked(next_, keep);
    keep_marked(candidates_, keep);
    if (keeps_clear_spaces_) keep_marked(clear_, keep);
}

void QuerySchedule::rearrange(const std::vector<std::size_t>& from) {
    std::vector<std::uint32_t> next(from.size(), kUnknown);
    std::vector<ContactCandidates> candidates(from.size());
    std::vector<ClearSpace> clear(keeps_clear_spaces_ ? from.size() : 0);
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (from[i] == kNew) continue;
        next[i] = next_[from[i]];
        candidates[i] = candidates_[from[i]];
        if (keeps_clear_spaces_) clear[i] = clear_[from[i]];
    }
    next_ = std::move(next);
    candidates_ = std::move(candidates);
    clear_ = std::move(clear);
}

void QuerySchedule::reset(std::size_t count, bool keeps_clear_spaces) {
    keeps_clear_spaces_ = keeps_clear_spaces;
    next_.assign(count, kUnknown);
    candidates_.assign(count, ContactCandidates{});
    clear_.assign(keeps_clear_spaces_ ? count : 0, ClearSpace{});
}

}  // namespace ricochet
