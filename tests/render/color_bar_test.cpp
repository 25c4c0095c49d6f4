#include "ricochet/render/color_bar.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "ricochet/render/lettering.h"

namespace ricochet {
namespace {

Image grey(int width, int height) {
    const std::size_t bytes = 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    return {width, height, std::vector<std::uint8_t>(bytes, 128)};
}

TEST(ColorBar, ShowsItsMapFromTheLowestToTheHighestColor) {
    Image image = grey(640, 360);
    draw_color_bars(image, {{"speed", "m/s", {0.0, 12.5}, ColorMap::plasma}});
    const BarPlace place = bar_place(640, 360, 0);
    const auto near = [](const std::array<int, 3>& pixel, std::array<int, 3> expected) {
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c], expected[c], 1);
    };
    near(image.pixel(place.x, place.y), {0x0d, 0x08, 0x87});
    near(image.pixel(place.x + place.width - 1, place.y + place.height - 1), {0xf0, 0xf9, 0x21});
    EXPECT_EQ(image.pixel(639, 0), (std::array<int, 3>{128, 128, 128}));
}

TEST(ColorBar, StandsInsideThePictureBesideTheOthers) {
    for (const auto& [width, height] : {std::pair{640, 360}, {1280, 720}, {1920, 1080}, {480, 480}}) {
        const BarPlace first = bar_place(width, height, 0);
        const BarPlace second = bar_place(width, height, 1);
        EXPECT_GT(second.x, first.x + first.width);
        EXPECT_LT(second.x + second.width, width);
        EXPECT_LT(first.y + first.height + kLetterHeight * first.dot, height);
    }
}

TEST(ColorBar, NumbersHaveThreeDigitsThatCount) {
    EXPECT_EQ(bar_number(0.0), "0");
    EXPECT_EQ(bar_number(-0.0), "0");
    EXPECT_EQ(bar_number(12.3456), "12.3");
    EXPECT_EQ(bar_number(1e-7), "1e-07");
    EXPECT_EQ(bar_number(1720000.0), "1.72M");
    EXPECT_EQ(bar_number(-45600.0), "-45.6k");
    EXPECT_EQ(bar_number(2500.0), "2.5k");
}

TEST(ColorBar, TinyPicturesStayAsTheyAre) {
    Image image = grey(64, 64);
    draw_color_bars(image, {{"speed", "m/s", {}, ColorMap::plasma}});
    EXPECT_EQ(image.rgb, grey(64, 64).rgb);
}

TEST(Lettering, DrawsLettersWhoseDotsAreSquares) {
    Image image = grey(40, 20);
    write_text(image, 2, 3, 2, "I");
    // The stem of an I is the third of its five columns.
    const auto lit = [&](int x, int y) { return image.pixel(x, y)[0] > 200; };
    for (int y = 3; y < 17; ++y) EXPECT_TRUE(lit(2 + 4, y) && lit(2 + 5, y)) << y;
    EXPECT_FALSE(lit(2, 9));
    EXPECT_EQ(text_width("I"), 5);
    EXPECT_EQ(text_width("II"), 11);
    write_text(image, -100, 500, 3, "outside");
}

}  // namespace
}  // namespace ricochet
