#include "ricochet/core/portable_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::scaled;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFewUlps = 4 * std::numeric_limits<double>::epsilon();

// The C library is accurate to about one ulp, but its results differ between systems.
TEST(PortableMath, AgreesWithTheLibraryToAFewUlps) {
    RandomSequence random(11, 0, 0);
    for (int i = 0; i < scaled(20000); ++i) {
        const double x = random.uniform_around(0, 700);
        EXPECT_NEAR(portable_exp(x) / std::exp(x), 1.0, kFewUlps) << x;
        const double y = std::exp(random.uniform_around(0, 700));
        EXPECT_NEAR(portable_log(y), std::log(y), kFewUlps * std::fabs(std::log(y))) << y;
        const double near_one = random.uniform_around(1.0, 0.5);
        EXPECT_NEAR(portable_log(near_one), std::log(near_one), kFewUlps * std::fabs(std::log(near_one))) << near_one;
        const double base = std::exp(random.uniform_around(0, 10));
        const double power = random.uniform_around(0, 5);
        const double bound = kFewUlps * (1.0 + std::fabs(power * std::log(base)));
        EXPECT_NEAR(portable_pow(base, power) / std::pow(base, power), 1.0, bound) << base << " ^ " << power;
        const double turns = random.uniform_around(0, 3);
        EXPECT_NEAR(sine_of_turns(turns), std::sin(2.0 * std::numbers::pi * turns), 1e-14) << turns;
    }
}

TEST(PortableMath, IsExactIfExactValuesExist) {
    EXPECT_EQ(portable_exp(0.0), 1.0);
    EXPECT_EQ(portable_log(1.0), 0.0);
    EXPECT_EQ(portable_pow(5.0, 0.0), 1.0);
    EXPECT_EQ(sine_of_turns(0.0), 0.0);
    EXPECT_EQ(sine_of_turns(0.5), 0.0);
    EXPECT_EQ(sine_of_turns(0x1p40 + 0.25), sine_of_turns(0.25));
    EXPECT_NEAR(sine_of_turns(0.25), 1.0, 1e-15);
    EXPECT_NEAR(sine_of_turns(-0.25), -1.0, 1e-15);
}

TEST(PortableMath, TheAngleOfASineAndCosineIsTheArcTangent) {
    RandomSequence random(12, 0, 0);
    const long double whole = 2.0L * std::acos(-1.0L);
    for (int i = 0; i < scaled(20000); ++i) {
        // Covers all magnitudes and all angles, including angles next to the axes.
        const double size = std::exp(random.uniform_around(0, 20));
        const double small = std::exp(-40.0 * random.uniform());
        const double sine = i % 2 == 0 ? size * random.uniform() : size * small;
        const double cosine = i % 3 == 0 ? size * random.uniform() : size;
        for (const auto& [s, c] : {std::pair{sine, cosine}, std::pair{cosine, sine}}) {
            if (s == 0.0 && c == 0.0) continue;
            const auto expected = static_cast<double>(std::atan2(static_cast<long double>(s), c) / whole);
            EXPECT_NEAR(turns_of(s, c), expected, kFewUlps * expected) << s << ' ' << c;
        }
    }
    EXPECT_EQ(turns_of(0.0, 3.0), 0.0);
    EXPECT_EQ(turns_of(3.0, 0.0), 0.25);
    EXPECT_NEAR(turns_of(3.0, 3.0), 0.125, 1e-16);
}

TEST(PortableMath, HandlesOverflowAndUnderflow) {
    EXPECT_EQ(portable_exp(-800.0), 0.0);
    EXPECT_EQ(portable_exp(-kInfinity), 0.0);
    EXPECT_EQ(portable_exp(710.0), kInfinity);
    EXPECT_GT(portable_exp(-745.0), 0.0);
    EXPECT_EQ(portable_log(0.0), -kInfinity);
    EXPECT_EQ(portable_log(kInfinity), kInfinity);
    EXPECT_NEAR(portable_log(0x1p-1074), -1074.0 * std::numbers::ln2, 1e-12);
    EXPECT_TRUE(std::isnan(portable_log(-1.0)));
    EXPECT_TRUE(std::isnan(portable_exp(std::nan(""))));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
