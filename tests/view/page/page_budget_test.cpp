#include "view/page/page_budget.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

namespace ricochet {
namespace RICOCHET_FILE {

// Returns the stage of a step of the ladder. 1: fewer bits, 2: fewer frames, 3: fewer particles, 4: fewer frames again.
int stage_of(const PageDetail& detail, const PageDetail& before) {
    if (detail.position_bits < before.position_bits || detail.value_bits < before.value_bits) return 1;
    if (detail.particles < before.particles) return 3;
    return before.particles < 1.0 ? 4 : 2;
}

TEST(DetailLadder, ReducesBitsThenFramesThenParticles) {
    const std::vector<PageDetail> ladder = detail_ladder(1000, 1'000'000);
    EXPECT_EQ(ladder.front().position_bits, 16);
    EXPECT_EQ(ladder.front().every_frame, 1U);
    EXPECT_EQ(ladder.front().particles, 1.0);
    int stage = 1;
    for (std::size_t i = 1; i < ladder.size(); ++i) {
        const int now = stage_of(ladder[i], ladder[i - 1]);
        EXPECT_GE(now, stage) << i;
        stage = now;
        EXPECT_GE(ladder[i].every_frame, ladder[i - 1].every_frame);
        EXPECT_GE(ladder[i].chosen_frames(1000).size(), 2U);
        EXPECT_TRUE(now != 2 || ladder[i].chosen_frames(1000).size() >= 50U) << i;
    }
    EXPECT_EQ(stage, 4);
    EXPECT_GE(1e6 * ladder.back().particles, 2000.0);
}

TEST(DetailLadder, SmallRunsKeepTheirFramesAndParticles) {
    for (const PageDetail& detail : detail_ladder(1, 100)) {
        EXPECT_EQ(detail.every_frame, 1U);
        EXPECT_EQ(detail.particles, 1.0);
    }
}

TEST(DetailLadder, PositionsKeepTheirLeastBits) {
    for (const int least : {11, 13, 14, 16}) {
        const std::vector<PageDetail> ladder = detail_ladder(1000, 1'000'000, least);
        EXPECT_EQ(ladder.back().position_bits, least);
        for (std::size_t i = 1; i < ladder.size(); ++i) {
            EXPECT_NE(
                std::tie(ladder[i].position_bits, ladder[i].value_bits, ladder[i].every_frame, ladder[i].particles),
                std::tie(ladder[i - 1].position_bits, ladder[i - 1].value_bits, ladder[i - 1].every_frame,
                         ladder[i - 1].particles));
        }
    }
}

TEST(NeededPositionBits, SpheresMoveByATenthOfTheirRadiusAtMost) {
    EXPECT_EQ(needed_position_bits(0.0, 10.0), kLeastPositionBits);
    EXPECT_EQ(needed_position_bits(1.0, 10.0), kLeastPositionBits);
    EXPECT_EQ(needed_position_bits(1e-9, 10.0), kMostPositionBits);
    for (const double radius : {0.02, 0.01, 0.005, 0.002}) {
        const auto off = [](int bits) { return 0.5 * std::sqrt(3.0) * 10.0 / (std::exp2(bits) - 1.0); };
        const int bits = needed_position_bits(radius, 10.0);
        EXPECT_LE(off(bits), 0.1 * radius);
        EXPECT_GT(off(bits - 1), 0.1 * radius);
    }
}

TEST(PageDetail, FirstAndLastFrameAreChosen) {
    for (const std::size_t every : {1U, 2U, 3U, 7U, 100U}) {
        const PageDetail detail{16, 16, every, 1.0};
        for (const std::size_t count : {1U, 2U, 10U, 50U}) {
            const std::vector<std::size_t> chosen = detail.chosen_frames(count);
            EXPECT_EQ(chosen.front(), 0U);
            EXPECT_EQ(chosen.back(), count - 1);
            for (std::size_t i = 1; i < chosen.size(); ++i) EXPECT_LT(chosen[i - 1], chosen[i]);
        }
    }
}

TEST(FirstFitting, FirstFittingDetailIsFoundWithFewTrials) {
    const std::vector<PageDetail> ladder = detail_ladder(2000, 5'000'000);
    const auto number_of = [&](const PageDetail& detail) {
        for (std::size_t i = 0; i < ladder.size(); ++i) {
            if (ladder[i].position_bits == detail.position_bits && ladder[i].value_bits == detail.value_bits &&
                ladder[i].every_frame == detail.every_frame && ladder[i].particles == detail.particles) {
                return i;
            }
        }
        return ladder.size();
    };
    for (std::size_t wanted = 0; wanted <= ladder.size(); ++wanted) {
        int looks = 0;
        const auto bytes = [&](const PageDetail& detail) {
            ++looks;
            return 1000.0 - static_cast<double>(number_of(detail));
        };
        EXPECT_EQ(first_fitting(ladder, 0, 1000.0 - static_cast<double>(wanted), bytes), wanted);
        EXPECT_LE(looks, 8);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
