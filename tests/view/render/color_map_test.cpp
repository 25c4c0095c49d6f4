#include "view/render/color_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ricochet {
namespace RICOCHET_FILE {

TEST(ColorMap, NamesLeadBackToTheirMaps) {
    for (const std::string_view name : color_map_names()) EXPECT_TRUE(color_map_from_name(name)) << name;
    EXPECT_EQ(color_map_from_name("turbo"), ColorMap::turbo);
    EXPECT_FALSE(color_map_from_name("jet"));
}

TEST(ColorMap, EndColoursMatchTheirSource) {
    const Vec3 last = map_color(ColorMap::viridis, 1.0);
    EXPECT_NEAR(srgb_from_linear(last.x), 0xfd / 255.0, 1e-9);
    EXPECT_NEAR(srgb_from_linear(last.y), 0xe7 / 255.0, 1e-9);
    EXPECT_NEAR(srgb_from_linear(last.z), 0x25 / 255.0, 1e-9);
    EXPECT_EQ(map_color(ColorMap::plasma, -3.0), map_color(ColorMap::plasma, 0.0));
    EXPECT_EQ(map_color(ColorMap::plasma, 1e300), map_color(ColorMap::plasma, 1.0));
}

TEST(ColorMap, PerceptualMapsGetLighterFromEndToEnd) {
    for (const ColorMap map : {ColorMap::viridis, ColorMap::plasma}) {
        double before = -1.0;
        for (int i = 0; i <= 100; ++i) {
            const Vec3 c = map_color(map, i / 100.0);
            const double luminance = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
            EXPECT_GT(luminance, before) << i;
            before = luminance;
        }
    }
}

TEST(ColorMap, NoNumberIsGrey) {
    const Vec3 grey = map_color(ColorMap::turbo, std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(grey.x, grey.y);
    EXPECT_EQ(grey.y, grey.z);
}

TEST(Srgb, ConversionsAreInverse) {
    for (int i = 0; i <= 255; ++i) EXPECT_NEAR(255.0 * srgb_from_linear(linear_from_srgb(i / 255.0)), i, 1e-4);
}

TEST(RobustRange, OutliersAreLeftOut) {
    std::vector<double> values;
    for (int i = 0; i <= 1000; ++i) values.push_back(i / 1000.0);
    values.push_back(1e12);
    values.push_back(std::numeric_limits<double>::infinity());
    values.push_back(std::numeric_limits<double>::quiet_NaN());
    const ValueRange range = robust_range(values);
    EXPECT_NEAR(range.low, 0.01, 0.002);
    EXPECT_NEAR(range.high, 0.99, 0.002);
}

TEST(RobustRange, FewValuesAreAllKept) {
    const ValueRange range = robust_range({300, 100, 900, 200, 800, 400, 700, 500, 600});
    EXPECT_EQ(range.low, 100.0);
    EXPECT_EQ(range.high, 900.0);
}

TEST(RobustRange, IsNeverEmpty) {
    EXPECT_LT(robust_range({}).low, robust_range({}).high);
    EXPECT_LT(robust_range({5.0, 5.0}).low, robust_range({5.0, 5.0}).high);
    EXPECT_LT(robust_range({0.0}).low, robust_range({0.0}).high);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
