/// \file
/// What a picture of a comparison shows, in a sentence or two made from the numbers.
#pragma once

#include <string>

#include "lab/compare/comparison.h"

namespace ricochet {

/// A number with three digits; `-` where it is none.
[[nodiscard]] std::string short_text(double number);

/// picture: one of kComparisonPictures. Throws std::invalid_argument for others.
[[nodiscard]] std::string reading_of(const std::string& picture, const Comparison& comparison);

}  // namespace ricochet
