#include "ricochet/collision/awaited.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace ricochet {
namespace {

TEST(Awaited, KnowsNothingUntilItIsToldAndThenUpToFourTriangles) {
    EXPECT_FALSE(Awaited().is_known());
    Awaited awaited = Awaited::none();
    ASSERT_TRUE(awaited.is_known());
    EXPECT_TRUE(awaited.triangles().empty());
    const std::vector<std::uint32_t> expected{7, 0, 123456789, 3};
    for (const std::uint32_t triangle : expected) awaited.add(triangle);
    ASSERT_TRUE(awaited.is_known());
    EXPECT_TRUE(std::ranges::equal(awaited.triangles(), expected));
    awaited.add(8);
    EXPECT_FALSE(awaited.is_known());
}

}  // namespace
}  // namespace ricochet
