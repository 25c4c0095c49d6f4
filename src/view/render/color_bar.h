/// \file
/// Colour bars in the lower left corner of a picture. They show the name, unit and range of each coloured quantity.
#pragma once

#include <string>
#include <vector>

#include "view/render/color_map.h"
#include "view/render/image.h"

namespace ricochet {

/// A quantity that is shown as colour.
struct ColorBar {
    std::string name;
    std::string unit;  ///< empty: no unit
    ValueRange range;
    ColorMap map = ColorMap::plasma;
    std::string note{};  ///< a line below the numbers; empty: no line
};

/// Position and size of a bar in a picture, in pixels, with x to the right and y down.
struct BarPosition {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
    int dot = 1;  ///< pixels per dot of its letters
};

/// Returns the positions of the bars of a picture. Each bar is as wide as its texts need. Bars stand side by side, and
/// wrap to a new row above if the picture is too narrow.
[[nodiscard]] std::vector<BarPosition> bar_places(int picture_width, int picture_height,
                                                  const std::vector<ColorBar>& bars);

/// Breaks a text into lines of at most `letters` characters, between words if possible.
[[nodiscard]] std::vector<std::string> broken_text(const std::string& text, std::size_t letters);

/// Draws the bars. Pictures less than 200 pixels wide or 100 pixels high are too small for bars and stay unchanged.
void draw_color_bars(Image& image, const std::vector<ColorBar>& bars);

/// Formats a number for a bar, with three significant digits.
[[nodiscard]] std::string bar_number(double value);

}  // namespace ricochet
