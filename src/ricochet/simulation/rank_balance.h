/// \file
/// Private to the simulation: the cost of the particles on each rank, and transfers of particles between ranks.
///
/// Work is counted and not measured, so that a repeated run with the same number of ranks has the same particles on
/// each rank. Results do not depend on the rank of a particle. The first rank of a particle: rank_share.h.
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
    std::uint64_t flying = 0;    ///< particles in free flight
    std::uint64_t idle = 0;      ///< asleep, frozen and pinned particles, which are skipped
    std::uint64_t contacts = 0;  ///< impacts of the moved particles

    /// Returns the work in tens of nanoseconds on one core, approximately.
    [[nodiscard]] std::uint64_t work() const;
};

/// Fractions of a rank's work, 0 to 1, that the rank transfers to each rank.
using RankTransfers = std::vector<double>;

/// Checks every few steps whether a rank has much more work than the others.
class RankBalancer {
public:
    /// Number of steps between two checks. In more steps, a rank whose particles have children could fall far behind.
    static constexpr std::uint64_t kSteps = 4;
    /// Number of checks after which the sums of work start again from 0.
    static constexpr std::uint64_t kChecks = 4;
    /// Busiest rank's work divided by the mean above which particles change ranks. Local: only the cost depends on it.
    static constexpr double kMostBusy = 1.1;
    /// Least work above the mean that is worth communication: 0.1 ms. Local: only the cost depends on it.
    static constexpr double kLeastExcess = 1e4;
    /// Work per particle of inserting transfers into a rank. A smaller excess waits. Local: only the cost depends on
    /// it.
    static constexpr double kMoveWork = 30.0;

    void note(const WorkCounts& counts) { work_ += counts.work(); }
    /// Checks the balance if a check is due. Must be called by all ranks at the start of each step. here: number of
    /// particles of this rank. If all particles keep their ranks, returns nothing on every rank.
    [[nodiscard]] std::optional<RankTransfers> check(Ranks& ranks, std::size_t here);
    /// Counts particles that have left this rank.
    void add_moved(std::uint64_t count) { moved_here_ += count; }
    [[nodiscard]] const RankBalance& balance() const { return balance_; }

private:
    void keep_account(const std::vector<std::uint64_t>& work);

    std::uint64_t steps_ = 0;         // number of steps since the last check
    std::uint64_t work_ = 0;          // work of this rank since the last check
    std::uint64_t moved_here_ = 0;    // particles that have left this rank since the last check
    std::uint64_t checks_ = 0;        // number of checks in sum_
    std::vector<std::uint64_t> sum_;  // work of each rank
    double busiest_ = 0.0;            // work of the busiest rank, summed over all checks
    double mean_ = 0.0;
    RankBalance balance_;
};

/// Returns the transfers from a rank. Ranks above the mean work give to ranks below it, both in ascending order.
[[nodiscard]] RankTransfers transfers_of(std::size_t rank, const std::vector<std::uint64_t>& work);

/// Selects for each particle the rank to which it moves, or kStays. The same fraction of particles leaves from each
/// cost class, spread evenly over the list. Idle particles stay.
class TransferChoice {
public:
    static constexpr std::uint32_t kStays = ~std::uint32_t{0};
    enum class Cost : std::uint8_t { queried, flying, idle };

    explicit TransferChoice(RankTransfers transfers) : transfers_(std::move(transfers)) {}
    /// Returns the selection for the next particle.
    [[nodiscard]] std::uint32_t next(Cost cost);

private:
    RankTransfers transfers_;
    std::uint64_t seen_[2] = {0, 0};
};

}  // namespace ricochet
