#include "ricochet/simulation/rank_balance.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace ricochet {
namespace {

/// Costs per particle or impact, in tens of nanoseconds (docs/design/many-machines.md), which do not change results.
constexpr std::uint64_t kQueriedWork = 150;
constexpr std::uint64_t kContactWork = 150;
constexpr std::uint64_t kFlyingWork = 6;
constexpr std::uint64_t kIdleWork = 1;

/// The inverse of the golden ratio, whose multiples fill the unit interval evenly. A mathematical constant.
constexpr double kGoldenPart = 0.6180339887498949;

double most_of(const std::vector<std::uint64_t>& work) { return static_cast<double>(*std::ranges::max_element(work)); }

double mean_of(const std::vector<std::uint64_t>& work) {
    return static_cast<double>(std::accumulate(work.begin(), work.end(), std::uint64_t{0})) /
           static_cast<double>(work.size());
}

}  // namespace

std::uint64_t WorkCounts::work() const {
    return kQueriedWork * queried + kContactWork * contacts + kFlyingWork * flying + kIdleWork * idle;
}

RankTransfers transfers_of(std::size_t rank, const std::vector<std::uint64_t>& work) {
    const double mean = mean_of(work);
    RankTransfers transfers(work.size(), 0.0);
    std::size_t taker = 0;
    double room = std::max(0.0, mean - static_cast<double>(work[0]));
    for (std::size_t giver = 0; giver < work.size(); ++giver) {
        double rest = static_cast<double>(work[giver]) - mean;
        while (rest > 0.0 && taker < work.size()) {
            const double transferred = std::min(rest, room);
            if (giver == rank) transfers[taker] += transferred / static_cast<double>(work[giver]);
            rest -= transferred;
            room -= transferred;
            if (room > 0.0) break;
            if (++taker < work.size()) room = std::max(0.0, mean - static_cast<double>(work[taker]));
        }
    }
    return transfers;
}

void RankBalancer::keep_account(const std::vector<std::uint64_t>& work) {
    const double most = most_of(work);
    const double mean = mean_of(work);
    busiest_ += most;
    mean_ += mean;
    balance_.busiest_now = mean > 0.0 ? most / mean : 1.0;
    balance_.busiest = mean_ > 0.0 ? busiest_ / mean_ : 1.0;
}

std::optional<RankTransfers> RankBalancer::check(Ranks& ranks, std::size_t here) {
    if (steps_++ < kSteps) return std::nullopt;
    steps_ = 1;
    std::vector<std::uint64_t> work(ranks.size() + 2, 0);
    work[ranks.rank()] = std::exchange(work_, 0);
    work[ranks.size()] = std::exchange(moved_here_, 0);
    work[ranks.size() + 1] = here;
    ranks.sum(work);
    const double particles = static_cast<double>(work.back()) / static_cast<double>(ranks.size());
    balance_.moved += work[ranks.size()];
    work.resize(ranks.size());
    keep_account(work);
    if (checks_++ == 0) sum_.assign(ranks.size(), 0);
    for (std::size_t rank = 0; rank < work.size(); ++rank) sum_[rank] += work[rank];
    const double excess = most_of(sum_) - mean_of(sum_);
    const bool is_behind = most_of(sum_) > kMostBusy * mean_of(sum_) && excess >= kLeastExcess;
    const bool pays = checks_ == kChecks || excess >= kMoveWork * particles;
    if (checks_ == kChecks || (is_behind && pays)) checks_ = 0;
    if (!is_behind || !pays) return std::nullopt;
    return transfers_of(ranks.rank(), sum_);
}

std::uint32_t TransferChoice::next(Cost cost) {
    if (cost == Cost::idle) return kStays;
    const double turn = static_cast<double>(seen_[static_cast<std::size_t>(cost)]++) * kGoldenPart;
    double left = turn - std::floor(turn);
    for (std::size_t rank = 0; rank < transfers_.size(); ++rank) {
        if (left < transfers_[rank]) return static_cast<std::uint32_t>(rank);
        left -= transfers_[rank];
    }
    return kStays;
}

}  // namespace ricochet
