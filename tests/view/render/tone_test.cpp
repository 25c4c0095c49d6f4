#include "view/render/tone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "view/render/color_map.h"

namespace ricochet {
namespace RICOCHET_FILE {

// Returns the exact value that the table of display_channel() replaces.
int rounded(double linear) {
    return static_cast<int>(std::lround(255.0 * srgb_from_linear(std::clamp(linear, 0.0, 1.0))));
}

// Both functions are increasing step functions, constant between two steps. They are compared on both sides of each of
// the 255 steps, at adjacent doubles, and on a fine grid. If they agree there, they agree everywhere: the rounding
// error of the power is far below 1000 ulps, so it cannot cross a step from farther away.
TEST(DisplayChannel, IsTheRoundedTransferFunctionOnBothSidesOfEveryStep) {
    for (int k = 1; k < 256; ++k) {
        const double step = linear_from_srgb((k - 0.5) / 255.0);
        const auto bits = std::bit_cast<std::uint64_t>(step);
        for (std::uint64_t away = 0; away <= 4000; ++away) {
            for (const std::uint64_t at : {bits - away, bits + away}) {
                const auto linear = std::bit_cast<double>(at);
                ASSERT_EQ(int{display_channel(linear)}, rounded(linear)) << linear;
            }
        }
        ASSERT_EQ(int{display_channel(step * (1.0 - 1e-9))}, k - 1);
        ASSERT_EQ(int{display_channel(step * (1.0 + 1e-9))}, k);
    }
}

TEST(DisplayChannel, IsTheRoundedTransferFunctionOnAFineGridBeyondBothEnds) {
    for (int k = -100000; k <= 1100000; ++k) ASSERT_EQ(int{display_channel(k * 1e-6)}, rounded(k * 1e-6)) << k;
    for (int cell = 0; cell <= 4096; ++cell) {
        const double edge = cell / 4096.0;
        for (const double linear : {std::nextafter(edge, -1.0), edge, std::nextafter(edge, 2.0)}) {
            ASSERT_EQ(int{display_channel(linear)}, rounded(linear)) << linear;
        }
    }
}

TEST(DisplayChannel, InvalidColoursAreClamped) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(display_channel(kInfinity), 255);
    EXPECT_EQ(display_channel(-kInfinity), 0);
    EXPECT_EQ(display_channel(std::numeric_limits<double>::quiet_NaN()), 0);
    EXPECT_EQ(display_channel(std::numeric_limits<double>::denorm_min()), 0);
}

TEST(ToneMapped, IsTheGlobalOperatorOnTheLuminanceAndKeepsColours) {
    for (const double bright : {1e-6, 0.18, 1.0, 3.0, 50.0}) {
        const Vec3 shown = tone_mapped(bright * Vec3{1, 1, 1});
        EXPECT_NEAR(luminance(shown) / (bright * (1.0 + bright / 9.0) / (1.0 + bright)), 1.0, 1e-14);
    }
    const Vec3 color = tone_mapped({0.8, 0.4, 0.2});
    EXPECT_NEAR(color.x / color.z, 4.0, 1e-14);
    EXPECT_EQ(tone_mapped({-1, 0, 0}), Vec3{});
    EXPECT_EQ(tone_mapped({}), Vec3{});
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
