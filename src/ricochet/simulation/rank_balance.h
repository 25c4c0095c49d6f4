/// \file
/// Private to the simulation: the cost of the particles on each rank, and transfers of particles between ranks.
///
/// Work is counted, not measured, so that a repeated run with as many ranks has the same particles on each of them. No
/// bit depends on the rank of a particle: births go by ids, children to the ranks of their parents, and nothing else
/// uses it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "ricochet/core/ranks.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// Numbers of particles in a substep, by the work that they cause.
struct WorkCounts {
    std::uint64_t queried = 0;   ///< particles that the response has moved
    std::uint64_t flying = 0;    ///< in free flight
    std::uint64_t idle = 0;      ///< asleep, frozen, pinned: they are skipped
    std::uint64_t contacts = 0;  ///< impacts of the moved particles

    /// Returns the work in tens of nanoseconds on one core, approximately.
    [[nodiscard]] std::uint64_t work() const;
};

/// Parts of its work, 0 to 1, that a rank gives to each rank.
using RankTransfers = std::vector<double>;

/// Checks every few steps whether a rank is behind.
class RankBalancer {
public:
    /// Steps from one check to the next. In so many steps a rank whose particles have children may fall behind.
    static constexpr std::uint64_t kSteps = 4;
    /// Checks after which the earlier work of ranks is forgotten.
    static constexpr std::uint64_t kLooks = 4;
    /// Work of the busiest rank over the mean from which on particles change ranks. Local, because only the cost
    /// depends on it.
    static constexpr double kMostBusy = 1.1;
    /// Work above the mean that is not worth the communication: a tenth of a millisecond. Local, because only the cost
    /// depends on it.
    static constexpr double kLeastGift = 1e4;
    /// Work to make room among the particles of a rank, for each of them. Less work above the mean can wait for more
    /// checks. Local, because only the cost depends on it.
    static constexpr double kMoveWork = 30.0;

    void note(const WorkCounts& counts) { work_ += counts.work(); }
    /// Must be called by all ranks at the start of each step. here: number of particles of this rank. Returns nothing,
    /// on all ranks alike, if all particles keep their ranks.
    [[nodiscard]] std::optional<RankTransfers> look(Ranks& ranks, std::size_t here);
    /// Counts particles that have left this rank.
    void add_moved(std::uint64_t count) { moved_here_ += count; }
    [[nodiscard]] const RankBalance& balance() const { return balance_; }

private:
    void keep_account(const std::vector<std::uint64_t>& work);

    std::uint64_t steps_ = 0;         // since the last check
    std::uint64_t work_ = 0;          // of this rank since then
    std::uint64_t moved_here_ = 0;    // particles given since then
    std::uint64_t looks_ = 0;         // checks in sum_
    std::vector<std::uint64_t> sum_;  // work of all ranks
    double busiest_ = 0.0;            // sum over all checks, of the busiest rank each time
    double mean_ = 0.0;
    RankBalance balance_;
};

/// Returns the transfers of a rank that give all ranks the mean work. Ranks with too much give in their order to ranks
/// with too little in theirs.
[[nodiscard]] RankTransfers gifts_of(std::size_t rank, const std::vector<std::uint64_t>& work);

/// Selects the particles that leave: for each the rank that it goes to, or kStays. The same share of the particles of
/// each cost leaves, evenly over the list. Particles that cost nothing stay.
class TransferChoice {
public:
    static constexpr std::uint32_t kStays = ~std::uint32_t{0};
    enum class Cost : std::uint8_t { queried, flying, idle };

    explicit TransferChoice(RankTransfers gifts) : gifts_(std::move(gifts)) {}
    /// Returns the selection for the next particle.
    [[nodiscard]] std::uint32_t next(Cost cost);

private:
    RankTransfers gifts_;
    std::uint64_t seen_[2] = {0, 0};
};

}  // namespace ricochet
