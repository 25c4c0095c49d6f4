// Vector units of the processor, and the vectors of four numbers that they compute with.
#include "ricochet/core/vector_unit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ricochet/core/quad.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::array<double, 4> numbers_in(const Quad& a) {
    std::array<double, 4> result{};
    store(a, result.data());
    return result;
}

TEST(VectorUnits, BeginWithTheBaselineAndAscend) {
    ASSERT_FALSE(vector_units().empty());
    EXPECT_EQ(vector_units().front(), VectorUnit::baseline);
    EXPECT_TRUE(std::is_sorted(vector_units().begin(), vector_units().end()));
}

TEST(Quad, ComputesEachLaneLikeADouble) {
    const std::array<double, 4> a{-0.0, 2.5, -kInfinity, kNan};
    const std::array<double, 4> b{0.0, -3.0, 1.0, 4.0};
    const Quad x = load_quad(a.data());
    const Quad y = load_quad(b.data());
    for (std::size_t lane = 0; lane < 4; ++lane) {
        SCOPED_TRACE(lane);
        const auto expect_same = [&](const Quad& four, double one) {
            const double found = numbers_in(four)[lane];
            EXPECT_TRUE(found == one || (std::isnan(found) && std::isnan(one))) << found << " and " << one;
            EXPECT_EQ(std::signbit(found), std::signbit(one));
        };
        expect_same(smaller(x, y), smaller(a[lane], b[lane]));
        expect_same(larger(x, y), larger(a[lane], b[lane]));
        expect_same(smaller(y, x), smaller(b[lane], a[lane]));
        expect_same(larger(y, x), larger(b[lane], a[lane]));
        expect_same(magnitude(x), magnitude(a[lane]));
        expect_same(root(magnitude(y)), root(magnitude(b[lane])));
        expect_same(quad_of(a[lane]), a[lane]);
    }
}

TEST(Quad, MasksHaveOneBitForEachLane) {
    const std::array<double, 4> a{1.0, -1.0, kNan, 3.0};
    const Quad x = load_quad(a.data());
    EXPECT_EQ(bits_of(x > 0.0), 0b1001U);
    EXPECT_EQ(bits_of((x > 0.0) | (x == -1.0)), 0b1011U);
    EXPECT_EQ(bits_of((x > 0.0) & (x > 2.0)), 0b1000U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
