#include "ricochet/core/algorithms.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

TEST(ForEachIf, VisitsEachMatchOnceInOrderAndNothingElse) {
    RandomSequence random(5, 0, 0);
    for (int i = 0; i < 300; ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        const double share = i % 3 == 0 ? 0.02 : (i % 3 == 1 ? 0.5 : 1.0);
        std::vector<std::uint8_t> is_match(static_cast<std::size_t>(100.0 * random.uniform()));
        for (std::uint8_t& flag : is_match) flag = random.uniform() < share ? 1 : 0;
        const auto end = is_match.size();
        const auto begin = static_cast<std::size_t>(static_cast<double>(end) * random.uniform());
        std::vector<std::size_t> expected;
        for (std::size_t k = begin; k < end; ++k) {
            if (is_match[k] != 0) expected.push_back(k);
        }
        std::vector<std::size_t> visited;
        for_each_if(
            begin, end, [&](std::size_t k) { return is_match[k] != 0; }, [&](std::size_t k) { visited.push_back(k); });
        EXPECT_EQ(visited, expected);
    }
}

TEST(KeepMarked, KeepsMarkedElementsInOrder) {
    RandomSequence random(11, 0, 0);
    for (int i = 0; i < 600; ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        const double share = std::array{0.0, 0.02, 0.5, 0.98, 1.0}[static_cast<std::size_t>(i) % 5];
        const std::size_t width = 1 + static_cast<std::size_t>(3.0 * random.uniform());
        std::vector<std::uint8_t> keep(static_cast<std::size_t>(60.0 * random.uniform()));
        for (std::uint8_t& mark : keep) mark = random.uniform() < share ? 1 : 0;
        std::vector<std::size_t> list(keep.size() * width);
        std::iota(list.begin(), list.end(), std::size_t{0});
        std::vector<std::size_t> expected;
        for (const std::size_t entry : list) {
            if (keep[entry / width] != 0) expected.push_back(entry);
        }
        keep_marked(list, keep, width);
        EXPECT_EQ(list, expected);
    }
}

TEST(KeepMarked, KeepsNothingOfAnEmptyList) {
    std::vector<int> list;
    keep_marked(list, {1, 0, 1});
    EXPECT_TRUE(list.empty());
}

TEST(GrowCapacityBy, AddsExactlyTheCapacityThatIsRequested) {
    std::vector<int> list(10, 3);
    grow_capacity_by(list, 1'000'000);
    EXPECT_EQ(list.capacity(), 1'000'010U);
    EXPECT_EQ(list, std::vector<int>(10, 3));
}

TEST(GrowCapacityBy, RarelyReallocatesAListThatGrowsByOne) {
    std::vector<int> list;
    int moves = 0;
    for (int i = 0; i < 100'000; ++i) {
        const std::size_t before = list.capacity();
        grow_capacity_by(list, 1);
        list.push_back(i);
        moves += list.capacity() != before ? 1 : 0;
    }
    EXPECT_LT(moves, 40);
    EXPECT_LE(list.capacity(), 150'000U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
