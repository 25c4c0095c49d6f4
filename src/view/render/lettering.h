/// \file
/// Small text in pictures, with letters of 5 x 8 dots.
#pragma once

#include <string_view>

#include "ricochet/core/vec3.h"
#include "view/render/image.h"

namespace ricochet {

inline constexpr int kLetterWidth = 6;   ///< dots from one letter to the next
inline constexpr int kLetterHeight = 8;  ///< in dots, with descenders

/// Returns the width of a text in dots, without the gap after its last letter.
[[nodiscard]] int text_width(std::string_view text);

/// Writes a text with its upper left corner at a pixel. Parts outside the picture are cut off. `dot` is the size of a
/// dot in pixels. Non-ASCII characters are shown as question marks.
void write_text(Image& image, int x, int y, int dot, std::string_view text);

/// Darkens a rectangle to the fraction `part` (0..1) of its display values, and makes it opaque.
void shade_rectangle(Image& image, int x, int y, int width, int height, double part);

/// Sets a pixel to a colour in linear light. Does nothing outside the picture.
void set_pixel(Image& image, int x, int y, const Vec3& color);

}  // namespace ricochet
