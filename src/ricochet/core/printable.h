/// \file
/// Text of strangers (names of files, messages of readers, fields of frames) as a terminal may show it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace ricochet {

/// The text with control characters, what turns the direction of writing, and what is not UTF-8 as escapes (\n, \x1b,
/// \u202e), which no terminal obeys. Text that is longer than `longest` bytes then is cut, and ends in "...".
[[nodiscard]] std::string printable(std::string_view text, std::size_t longest = std::string_view::npos);

/// True for text that is printable as it is, and that a column of a table may be named: without commas and quotes.
[[nodiscard]] bool is_column_name(std::string_view text);

}  // namespace ricochet
