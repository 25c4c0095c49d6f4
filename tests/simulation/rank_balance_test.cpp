// Transfers from slow ranks and the choice of their particles, compared with closed forms.
#include "ricochet/simulation/rank_balance.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <vector>

#include "ricochet/core/random.h"
#include "support/thread_ranks.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Work = std::vector<std::uint64_t>;

/// Returns the work of each rank after all transfers.
std::vector<double> after_transfers(const Work& work) {
    std::vector<double> after(work.begin(), work.end());
    for (std::size_t from = 0; from < work.size(); ++from) {
        const RankTransfers transfers = transfers_of(from, work);
        for (std::size_t to = 0; to < work.size(); ++to) {
            EXPECT_GE(transfers[to], 0.0);
            after[from] -= transfers[to] * static_cast<double>(work[from]);
            after[to] += transfers[to] * static_cast<double>(work[from]);
        }
    }
    return after;
}

TEST(RankTransfers, TransfersEqualiseTheWork) {
    EXPECT_EQ(transfers_of(0, {300, 100}), (RankTransfers{0.0, 1.0 / 3.0}));
    EXPECT_EQ(transfers_of(1, {300, 100}), (RankTransfers{0.0, 0.0}));
    EXPECT_EQ(transfers_of(2, {0, 0, 900}), (RankTransfers{1.0 / 3.0, 1.0 / 3.0, 0.0}));
    EXPECT_EQ(transfers_of(0, {5, 5, 5}), (RankTransfers{0.0, 0.0, 0.0}));
    EXPECT_EQ(transfers_of(0, {0, 0}), (RankTransfers{0.0, 0.0}));
    RandomSequence random(71, 0, 0);
    for (int round = 0; round < 1000; ++round) {
        Work work(1 + static_cast<std::size_t>(random.uniform() * 12.0));
        for (std::uint64_t& one : work) one = static_cast<std::uint64_t>(random.uniform() * random.uniform() * 1e6);
        const double mean = static_cast<double>(std::accumulate(work.begin(), work.end(), std::uint64_t{0})) /
                            static_cast<double>(work.size());
        for (const double left : after_transfers(work))
            EXPECT_NEAR(left, mean, 1e-6 * (1.0 + mean)) << "round " << round;
    }
}

TEST(TransferChoice, EqualShareOfEachCostIsChosenAndNoIdleParticles) {
    TransferChoice choice({0.0, 0.25, 0.1});
    std::vector<std::vector<int>> gone(2, std::vector<int>(3, 0));
    constexpr int kEach = 10'000;
    for (int k = 0; k < kEach; ++k) {
        for (const auto cost : {TransferChoice::Cost::queried, TransferChoice::Cost::flying}) {
            const std::uint32_t rank = choice.next(cost);
            if (rank != TransferChoice::kStays) ++gone[static_cast<std::size_t>(cost)][rank];
        }
        EXPECT_EQ(choice.next(TransferChoice::Cost::idle), TransferChoice::kStays);
    }
    for (const std::vector<int>& of_cost : gone) {
        EXPECT_EQ(of_cost[0], 0);
        EXPECT_NEAR(of_cost[1], 0.25 * kEach, 3.0);
        EXPECT_NEAR(of_cost[2], 0.1 * kEach, 3.0);
    }
}

/// Returns true if ranks with the given work per step and number of particles transfer any particles in this many
/// steps.
bool is_moved(const Work& each_step, std::size_t particles, std::uint64_t steps) {
    bool is_moved = false;
    testing::on_ranks(each_step.size(), [&](const std::shared_ptr<Ranks>& ranks) {
        RankBalancer balancer;
        bool any = false;
        for (std::uint64_t k = 0; k < steps; ++k) {
            any |= balancer.check(*ranks, particles).has_value();
            WorkCounts counts;
            counts.idle = each_step[ranks->rank()];
            balancer.note(counts);
        }
        if (ranks->rank() == 0) is_moved = any;
    });
    return is_moved;
}

TEST(RankBalancer, TransferStartsIfARankIsMoreThanATenthBehind) {
    constexpr std::uint64_t kMany = 1'000'000;
    EXPECT_FALSE(is_moved({kMany, kMany}, 100, 40));
    EXPECT_FALSE(is_moved({kMany * 109, kMany * 91}, 100, 40));
    EXPECT_TRUE(is_moved({kMany * 112, kMany * 88}, 100, 40));
    EXPECT_TRUE(is_moved({kMany * 112, kMany * 88}, 100, RankBalancer::kSteps + 1)) << "at the first check";
    EXPECT_FALSE(is_moved({100, 0}, 100, 40)) << "a microsecond is not worth it";
    // For so many particles, the storage costs more than a few steps gain, but not more than sixteen.
    EXPECT_FALSE(is_moved({kMany * 112, kMany * 88}, 10 * kMany, RankBalancer::kSteps + 1));
    EXPECT_TRUE(is_moved({kMany * 112, kMany * 88}, 10 * kMany, RankBalancer::kChecks * RankBalancer::kSteps + 1));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
