/// \file
/// Small text in pictures, with letters of 5 x 8 dots.
#pragma once

#include <string_view>

#include "ricochet/core/vec3.h"
#include "view/render/image.h"

namespace ricochet {

inline constexpr int kLetterWidth = 6;   ///< distance from one letter to the next, in dots
inline constexpr int kLetterHeight = 8;  ///< height of a letter with descenders, in dots

/// Returns the width of a text in dots, without the gap after its last letter.
[[nodiscard]] int text_width(std::string_view text);

/// Writes a text whose upper left corner is at the pixel (x, y). Parts outside the picture are cut off. `dot` is the
/// size of a dot in pixels. Characters that are not printable ASCII are shown as question marks.
void write_text(Image& image, int x, int y, int dot, std::string_view text);

/// Multiplies the display values of a rectangle by `part` (0..1), and makes the rectangle opaque.
void shade_rectangle(Image& image, int x, int y, int width, int height, double part);

/// Sets a pixel to a colour in linear light. Does nothing if the pixel is outside the picture.
void set_pixel(Image& image, int x, int y, const Vec3& color);

}  // namespace ricochet
