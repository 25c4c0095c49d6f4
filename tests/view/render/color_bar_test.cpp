#include "view/render/color_bar.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "view/render/lettering.h"

namespace ricochet {
namespace RICOCHET_FILE {

Image grey(int width, int height) {
    const std::size_t bytes = 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    return {width, height, std::vector<std::uint8_t>(bytes, 128)};
}

TEST(ColorBar, ShowsItsMapFromTheLowestToTheHighestColor) {
    Image image = grey(640, 360);
    const std::vector<ColorBar> bars = {{"speed", "m/s", {0.0, 12.5}, ColorMap::plasma}};
    draw_color_bars(image, bars);
    const BarPosition bar_position = compute_bar_positions(640, 360, bars)[0];
    const auto near = [](const std::array<int, 3>& pixel, std::array<int, 3> expected) {
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c], expected[c], 1);
    };
    near(image.pixel(bar_position.x, bar_position.y), {0x0d, 0x08, 0x87});
    near(image.pixel(bar_position.x + bar_position.width - 1, bar_position.y + bar_position.height - 1),
         {0xf0, 0xf9, 0x21});
    EXPECT_EQ(image.pixel(639, 0), (std::array<int, 3>{128, 128, 128}));
}

TEST(ColorBar, BarsStandInsideThePictureBesideEachOther) {
    for (const auto& [width, height] : {std::pair{640, 360}, {1280, 720}, {1920, 1080}, {480, 480}}) {
        const std::vector<BarPosition> bar_positions =
            compute_bar_positions(width, height, {{"speed", "m/s", {}}, {"hits", "", {}}});
        const BarPosition& first = bar_positions[0];
        const BarPosition& second = bar_positions[1];
        EXPECT_GT(second.x, first.x + first.width);
        EXPECT_LT(second.x + second.width, width);
        EXPECT_LT(first.y + first.height + kLetterHeight * first.dot, height);
    }
}

// A name of 60 letters with its unit.
TEST(ColorBar, ShowsTheWholeLabel) {
    const std::string name = "a_very_long_name_of_an_attribute_that_somebody_has_thought_of";
    for (const auto& [width, height] : {std::pair{640, 360}, {1280, 720}, {200, 400}, {1000, 120}}) {
        const std::vector<ColorBar> bars = {{name, "m/s", {0.0, 1.0}}, {name, "K", {0.0, 1.0}}};
        const std::vector<BarPosition> bar_positions = compute_bar_positions(width, height, bars);
        for (const BarPosition& bar_position : bar_positions) {
            EXPECT_GE(bar_position.x, 0);
            EXPECT_LE(bar_position.x + bar_position.width, width);
        }
        const bool is_beside = bar_positions[1].x > bar_positions[0].x + bar_positions[0].width;
        EXPECT_TRUE(is_beside || bar_positions[1].y + bar_positions[1].height < bar_positions[0].y);
        std::string whole;
        for (const std::string& line : broken_text(name + " (m/s)", 29)) {
            EXPECT_LE(line.size(), 29U);
            whole += line;
        }
        EXPECT_EQ(whole, name + " (m/s)");
    }
    // Light pixels of letters extend to the end of the text.
    Image image = grey(960, 540);
    const std::vector<ColorBar> bars = {{"unsimulated_time_of_all", "s", {0.0, 1.0}}};
    draw_color_bars(image, bars);
    const BarPosition bar_position = compute_bar_positions(960, 540, bars)[0];
    EXPECT_GE(bar_position.width, text_width("unsimulated_time_of_all (s)"));
    bool is_lit = false;
    for (int y = bar_position.y - kLetterHeight - 3; y < bar_position.y; ++y) {
        for (int x = bar_position.x + bar_position.width - 5; x < bar_position.x + bar_position.width; ++x) {
            is_lit = is_lit || image.pixel(x, y)[0] > 200;
        }
    }
    EXPECT_TRUE(is_lit);
}

TEST(ColorBar, BreaksTextsBetweenWords) {
    using Lines = std::vector<std::string>;
    EXPECT_EQ(broken_text("", 5), Lines{});
    EXPECT_EQ(broken_text("abc de", 6), Lines{"abc de"});
    EXPECT_EQ(broken_text("abc de", 5), (Lines{"abc", "de"}));
    EXPECT_EQ(broken_text("abcdef g", 3), (Lines{"abc", "def", "g"}));
}

TEST(ColorBar, ANoteStandsBelowTheNumbers) {
    Image image = grey(960, 540);
    const std::vector<ColorBar> plain = {{"hits", "", {0.0, 1.0}}};
    std::vector<ColorBar> noted = plain;
    noted[0].note = "impacts only";
    const int line = kLetterHeight + 3;
    EXPECT_EQ(compute_bar_positions(960, 540, noted)[0].y, compute_bar_positions(960, 540, plain)[0].y - line);
    draw_color_bars(image, noted);
    const BarPosition bar_position = compute_bar_positions(960, 540, noted)[0];
    bool is_lit = false;
    for (int y = bar_position.y + bar_position.height + 3 + line;
         y < bar_position.y + bar_position.height + 3 + 2 * line; ++y) {
        for (int x = bar_position.x; x < bar_position.x + bar_position.width; ++x)
            is_lit = is_lit || image.pixel(x, y)[0] > 200;
    }
    EXPECT_TRUE(is_lit);
}

TEST(ColorBar, NumbersHaveThreeSignificantDigits) {
    EXPECT_EQ(bar_number(0.0), "0");
    EXPECT_EQ(bar_number(-0.0), "0");
    EXPECT_EQ(bar_number(12.3456), "12.3");
    EXPECT_EQ(bar_number(1e-7), "1e-07");
    EXPECT_EQ(bar_number(1720000.0), "1.72M");
    EXPECT_EQ(bar_number(-45600.0), "-45.6k");
    EXPECT_EQ(bar_number(2500.0), "2.5k");
}

TEST(ColorBar, TinyPicturesStayUnchanged) {
    Image image = grey(64, 64);
    draw_color_bars(image, {{"speed", "m/s", {}, ColorMap::plasma}});
    EXPECT_EQ(image.rgb, grey(64, 64).rgb);
}

TEST(Lettering, DrawsLettersWithSquareDots) {
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

}  // namespace RICOCHET_FILE
}  // namespace ricochet
