/// \file
/// What to do about JSON that cannot be read, for the faults that hands make.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace ricochet::detail {

struct JsonHint {
    std::size_t position = 0;  ///< byte of the text where it is, from 0
    std::string text;
};

/// A comma or a colon that is missing, or a comma too many. position: bytes that the parser has read when it stopped;
/// message: what it says. Nothing for other faults.
[[nodiscard]] std::optional<JsonHint> json_hint(std::string_view text, std::size_t position, std::string_view message);

}  // namespace ricochet::detail
