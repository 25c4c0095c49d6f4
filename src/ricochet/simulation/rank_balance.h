/// \file
/// Private to the simulation: what the particles of ranks cost, and which rank is to give how many of them to which.
///
/// Work is counted, not measured, so that a run that is repeated with as many ranks has the same particles on each of
/// them. No bit depends on where a particle lives: births go by ids, children to where their parents are, and nothing
/// else asks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "ricochet/core/ranks.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// What particles do in a part of a step.
struct WorkCounts {
    std::uint64_t queried = 0;   ///< particles that the response has moved
    std::uint64_t flying = 0;    ///< in free flight
    std::uint64_t idle = 0;      ///< asleep, frozen, pinned: they are passed by
    std::uint64_t contacts = 0;  ///< impacts of those that were moved

    /// In tens of nanoseconds on one core, about.
    [[nodiscard]] std::uint64_t work() const;
};

/// By how much of its work, 0 to 1, a rank is to give to each.
using RankTransfers = std::vector<double>;

/// Looks every few steps whether a rank is behind.
class RankBalancer {
public:
    /// Steps from one look to the next: in so many a rank whose particles have children may fall behind.
    static constexpr std::uint64_t kSteps = 4;
    /// Looks after which what ranks have done is forgotten.
    static constexpr std::uint64_t kLooks = 4;
    /// Work of the busiest rank over the mean from which on particles change ranks. Local, because only the cost
    /// depends on it.
    static constexpr double kMostBusy = 1.1;
    /// Work above the mean that is not worth the talk: a tenth of a millisecond. Local, because only the cost depends
    /// on it.
    static constexpr double kLeastGift = 1e4;
    /// What it costs to make room among the particles of a rank, each: less work above the mean can wait for more
    /// looks. Local, because only the cost depends on it.
    static constexpr double kMoveWork = 30.0;

    void note(const WorkCounts& counts) { work_ += counts.work(); }
    /// At the begin of each step; all ranks call it. here: particles of this rank. Nothing where all particles stay
    /// where they are, which is the same on all ranks.
    [[nodiscard]] std::optional<RankTransfers> look(Ranks& ranks, std::size_t here);
    /// So many have left this rank.
    void add_moved(std::uint64_t count) { moved_here_ += count; }
    [[nodiscard]] const RankBalance& balance() const { return balance_; }

private:
    void keep_account(const std::vector<std::uint64_t>& work);

    std::uint64_t steps_ = 0;         // since the last look
    std::uint64_t work_ = 0;          // of this rank since then
    std::uint64_t moved_here_ = 0;    // and particles given since then
    std::uint64_t looks_ = 0;         // of the sums that are next
    std::vector<std::uint64_t> sum_;  // work of all ranks
    double busiest_ = 0.0;            // sum over all looks, of the busiest each time
    double mean_ = 0.0;
    RankBalance balance_;
};

/// What the given rank gives so that all have the mean of these. Those that have too much give in their order to those
/// that have too little in theirs.
[[nodiscard]] RankTransfers gifts_of(std::size_t rank, const std::vector<std::uint64_t>& work);

/// Which particles leave: for each the rank that it goes to, or kStays. Of particles of each cost as many, evenly over
/// the list; those that cost nothing stay.
class TransferChoice {
public:
    static constexpr std::uint32_t kStays = ~std::uint32_t{0};
    enum class Cost : std::uint8_t { queried, flying, idle };

    explicit TransferChoice(RankTransfers gifts) : gifts_(std::move(gifts)) {}
    /// Of the next particle.
    [[nodiscard]] std::uint32_t next(Cost cost);

private:
    RankTransfers gifts_;
    std::uint64_t seen_[2] = {0, 0};
};

}  // namespace ricochet
