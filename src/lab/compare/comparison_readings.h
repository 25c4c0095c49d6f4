/// \file
/// Sentences that describe the pictures of a comparison, made from the numbers.
#pragma once

#include <string>

#include "lab/compare/comparison.h"

namespace ricochet {

/// Returns a number with three digits, or `-` if it is not finite.
[[nodiscard]] std::string short_text(double number);

/// Returns one or two sentences that describe a picture, which is one of kComparisonPictures. Throws
/// std::invalid_argument for others.
[[nodiscard]] std::string reading_of(const std::string& picture, const Comparison& comparison);

}  // namespace ricochet
