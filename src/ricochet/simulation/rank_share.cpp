#include "ricochet/simulation/rank_share.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <limits>
#include <tuple>

#include "ricochet/core/error.h"

namespace ricochet {

void RankShare::require_alone(const char* call) const {
    if (is_alone()) return;
    throw InputError(fmt::format("{}: found a run that {} ranks share, expected one process", call, ranks_->size()));
}

void RankShare::keep_together(std::vector<std::uint64_t> ids) {
    std::ranges::sort(ids);
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    together_ = std::move(ids);
}

// Compares bit patterns, because the bit patterns of positive numbers have the same order as the numbers.
double RankShare::shortest(double duration) const {
    std::array<std::uint64_t, 1> bits{std::bit_cast<std::uint64_t>(duration)};
    ranks_->least(bits);
    return std::bit_cast<double>(bits[0]);
}

void RankShare::end_step(std::size_t living_here, const ColliderList& colliders) {
    std::array<std::uint64_t, 2> values{living_here, new_lost_times_.size() + new_loads_.size()};
    ranks_->sum(values);
    living_ = values[0];
    if (values[1] >= kManyTerms) add_up(colliders);
}

std::optional<std::string> RankShare::first_message(const std::optional<std::string>& message, std::uint64_t id) const {
    if (is_alone()) return message;
    constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();
    std::array<std::uint64_t, 1> least{message ? id : kNone};
    ranks_->least(least);
    if (least[0] == kNone) return std::nullopt;
    std::vector<char> mine;
    if (message && id == least[0]) mine.assign(message->begin(), message->end());
    const std::vector<char> all = gather_list_to_all(*ranks_, mine);
    return std::string(all.begin(), all.end());
}

void RankShare::begin_sums(double unsimulated_time, const std::vector<ColliderTotals>& colliders) {
    unsimulated_time_ = unsimulated_time;
    loads_ = colliders;
    new_lost_times_.clear();
    new_loads_.clear();
}

void RankShare::note(const std::vector<BlockRecord>& blocks, const std::vector<std::uint64_t>& id) {
    ++part_;
    for (const BlockRecord& block : blocks) {
        for (const CutOff& entry : block.cut_off) new_lost_times_.push_back({part_, id[entry.particle], entry.time});
        if (loads_.empty()) continue;
        for (const ColliderLoad& load : block.loads) new_loads_.push_back({part_, load});
    }
}

// A stable sort keeps the terms of a particle in the order of events, because all of them come from one rank.
void RankShare::add_up(const ColliderList& colliders) {
    std::vector<LostTime> times = gather_list(*ranks_, new_lost_times_);
    std::vector<Load> loads = gather_list(*ranks_, new_loads_);
    new_lost_times_.clear();
    new_loads_.clear();
    std::ranges::stable_sort(times, [](const LostTime& a, const LostTime& b) {
        return std::tuple(a.part, a.particle) < std::tuple(b.part, b.particle);
    });
    std::ranges::stable_sort(loads, [](const Load& a, const Load& b) {
        return std::tuple(a.part, a.load.particle) < std::tuple(b.part, b.load.particle);
    });
    for (const LostTime& entry : times) unsimulated_time_ += entry.time;
    for (const Load& entry : loads) add_load(loads_, entry.load, colliders);
}

}  // namespace ricochet
