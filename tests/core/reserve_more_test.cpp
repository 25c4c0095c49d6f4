#include "ricochet/core/reserve_more.h"

#include <gtest/gtest.h>

namespace ricochet {
namespace {

TEST(ReserveMore, MakesExactlyTheRoomThatManyNeedAtOnce) {
    std::vector<int> list(10, 3);
    reserve_more(list, 1'000'000);
    EXPECT_EQ(list.capacity(), 1'000'010U);
    EXPECT_EQ(list, std::vector<int>(10, 3));
}

TEST(ReserveMore, MovesAListThatGrowsByLittleOnlyNowAndThen) {
    std::vector<int> list;
    int moves = 0;
    for (int i = 0; i < 100'000; ++i) {
        const std::size_t before = list.capacity();
        reserve_more(list, 1);
        list.push_back(i);
        moves += list.capacity() != before ? 1 : 0;
    }
    EXPECT_LT(moves, 40);
    EXPECT_LE(list.capacity(), 150'000U);
}

}  // namespace
}  // namespace ricochet
