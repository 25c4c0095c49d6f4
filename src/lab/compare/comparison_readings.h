/// \file
/// Generated sentences that describe the pictures of a comparison.
#pragma once

#include <string>

#include "lab/compare/comparison.h"

namespace ricochet {

/// Returns a number with three digits, or `-` if it is not finite.
[[nodiscard]] std::string short_text(double number);

/// Returns one or two sentences that describe a picture. `picture` must be one of kComparisonPictures, otherwise
/// std::invalid_argument is thrown.
[[nodiscard]] std::string describe_picture(const std::string& picture, const Comparison& comparison);

}  // namespace ricochet
