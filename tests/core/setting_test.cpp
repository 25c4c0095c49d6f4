#include "ricochet/core/setting.h"

#include <gtest/gtest.h>

#include <limits>

namespace ricochet {
namespace RICOCHET_FILE {

struct Oven {
    double heat = 0.5;
    std::uint32_t plates = 1;
};
constexpr Setting<Oven> kOvenTable[] = {{"heat", &Oven::heat, kFraction, "", "Fraction of the full power."},
                                        {"plates", &Oven::plates, kCountFromOne, "", "Number of plates."}};

TEST(SettingTable, FirstMemberOutsideItsRangeIsNamed) {
    EXPECT_EQ(first_refusal(Oven{}, kOvenTable), "");
    EXPECT_EQ(first_refusal(Oven{2.0, 0}, kOvenTable, "oven."), "oven.heat: found 2, expected a number from 0 to 1");
    EXPECT_EQ(first_refusal(Oven{1.0, 0}, kOvenTable), "plates: found 0, expected at least 1");
}

TEST(SettingTable, RefusalsTellTheViolatedEndOfTheRange) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(refusal(0.0, kPositive, "s"), "found 0, expected a finite number above 0 (s)");
    EXPECT_EQ(refusal(kInfinity, kPositive, "s"), "found inf, expected a finite number above 0 (s)");
    EXPECT_EQ(refusal(kNan, kNotNegative, ""), "found nan, expected a finite number of at least 0");
    EXPECT_EQ(refusal(1e80, kLength, "m"), "found 1e+80, expected at most 1e+75 m");
    EXPECT_EQ(refusal(-1e80, kCoordinate, "m"), "found -1e+80, expected at most 1e+75 m in magnitude");
    EXPECT_EQ(refusal(kNan, kAnyNumber, "N"), "found nan, expected a finite number (N)");
    EXPECT_EQ(refusal(-4.0, kTemperature, "K"), "found -4, expected a number from 0 to 1e+12 (K)");
    EXPECT_EQ(refusal(kInfinity, kPositiveOrInfinite, ""), "");
    EXPECT_EQ(refusal(0.0, kPositiveOrInfinite, ""), "found 0, expected a number above 0");
    EXPECT_EQ(refusal(2e6, positive_up_to(1e6), "1/s"), "found 2000000, expected at most 1e+06 1/s");
    EXPECT_EQ(refusal(std::uint64_t{1} << 32U, kCount, ""), "found 4294967296, expected a number below 2^32");
    EXPECT_EQ(refusal(Vec3{0, 1e80, 0}, kCoordinate, "m"),
              "found [0, 1e+80, 0], expected finite numbers of at most 1e+75 m");
    EXPECT_EQ(refusal(std::optional<double>(), kPositive, "K"), "");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
