/// \file
/// What the colours of a picture mean, in its lower left corner: bars with name, unit and range.
#pragma once

#include <string>
#include <vector>

#include "view/render/color_map.h"
#include "view/render/image.h"

namespace ricochet {

/// A quantity that colours something.
struct ColorBar {
    std::string name;
    std::string unit;  ///< empty: none
    ValueRange range;
    ColorMap map = ColorMap::plasma;
    std::string note{};  ///< a line below the numbers; empty: none
};

/// Where a bar stands in a picture, pixels; x to the right, y down.
struct BarPlace {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
    int dot = 1;  ///< pixels a dot of its letters
};

/// Returns the places of the bars of a picture. Each is as wide as its texts need; they stand beside each other, and
/// above each other where the picture is too narrow.
[[nodiscard]] std::vector<BarPlace> bar_places(int picture_width, int picture_height,
                                               const std::vector<ColorBar>& bars);

/// Breaks a text into lines of at most so many letters, between words where it can.
[[nodiscard]] std::vector<std::string> broken_text(const std::string& text, std::size_t letters);

/// Draws the bars. Pictures less than 200 pixels wide or 100 high have no room for them and stay as they are.
void draw_color_bars(Image& image, const std::vector<ColorBar>& bars);

/// A number as a bar shows it: three digits that count.
[[nodiscard]] std::string bar_number(double value);

}  // namespace ricochet
