/// \file
/// Small text in pictures, in letters of 5 x 8 dots.
#pragma once

#include <string_view>

#include "ricochet/core/vec3.h"
#include "view/render/image.h"

namespace ricochet {

inline constexpr int kLetterWidth = 6;   ///< dots from one letter to the next
inline constexpr int kLetterHeight = 8;  ///< dots, with what hangs below the line

/// Width of a text in dots, without the gap after its last letter.
[[nodiscard]] int text_width(std::string_view text);

/// Writes a text with its upper left corner at a pixel; what is outside of the picture is cut off. dot: pixels a dot.
/// Characters other than those of ASCII are shown as a question mark.
void write_text(Image& image, int x, int y, int dot, std::string_view text);

/// Darkens a rectangle to a part of its light, 0..1, in the display's values; it becomes opaque.
void shade_rectangle(Image& image, int x, int y, int width, int height, double part);

/// Sets a pixel, unless it is outside of the picture. color: linear light.
void set_pixel(Image& image, int x, int y, const Vec3& color);

}  // namespace ricochet
