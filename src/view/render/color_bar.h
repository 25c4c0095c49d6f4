/// \file
/// Colour bars in the lower left corner of a picture. Each bar shows the name, unit and range of a quantity that
/// colours particles or colliders.
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
    std::string note{};  ///< text below the numbers; empty: no text
};

/// Position and size of a bar in a picture, in pixels, with x to the right and y down.
struct BarPosition {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
    int dot = 1;  ///< size of a dot of the letters, in pixels
};

/// Returns the positions of the bars of a picture. Each bar is at least as wide as its texts. Bars are placed side by
/// side. If the picture is too narrow, the next bars are placed in a new row above.
[[nodiscard]] std::vector<BarPosition> compute_bar_positions(int picture_width, int picture_height,
                                                             const std::vector<ColorBar>& bars);

/// Breaks a text into lines of at most `letters` characters, between words if possible.
[[nodiscard]] std::vector<std::string> broken_text(const std::string& text, std::size_t letters);

/// Draws the bars. Pictures less than 200 pixels wide or 100 pixels high are too small for bars and stay unchanged.
void draw_color_bars(Image& image, const std::vector<ColorBar>& bars);

/// Returns a number as text with three significant digits. Large numbers have a suffix k, M or G.
[[nodiscard]] std::string bar_number(double value);

}  // namespace ricochet
