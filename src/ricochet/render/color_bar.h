/// \file
/// What the colours of a picture mean, in its lower left corner: bars with name, unit and range.
#pragma once

#include <string>
#include <vector>

#include "ricochet/render/color_map.h"
#include "ricochet/render/image.h"

namespace ricochet {

/// A quantity that colours something.
struct ColorBar {
    std::string name;
    std::string unit;  ///< empty: none
    ValueRange range;
    ColorMap map = ColorMap::plasma;
};

/// Where a bar stands in a picture, pixels; x to the right, y down.
struct BarPlace {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
    int dot = 1;  ///< pixels a dot of its letters
};

/// The place of a bar, by its number among those of the picture. They stand beside each other.
[[nodiscard]] BarPlace bar_place(int picture_width, int picture_height, std::size_t number);

/// Draws the bars. Pictures less than 200 pixels wide or 100 high have no room for them and stay as they are.
void draw_color_bars(Image& image, const std::vector<ColorBar>& bars);

/// A number as a bar shows it: three digits that count.
[[nodiscard]] std::string bar_number(double value);

}  // namespace ricochet
