/// \file
/// Makes text from outside (file names, messages of readers, fields of frames) safe to show in a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace ricochet {

/// Returns the text with escapes (\n, \x1b, \u202e) instead of characters that a terminal obeys. Escapes replace
/// control characters, characters that change the writing direction, and bytes that are not UTF-8. A result longer than
/// `longest` bytes is cut and ends in "...".
[[nodiscard]] std::string printable(std::string_view text, std::size_t longest = std::string_view::npos);

/// Returns true if the text is printable without escapes and can name a column of a table: it has no commas and quotes.
[[nodiscard]] bool is_column_name(std::string_view text);

}  // namespace ricochet
