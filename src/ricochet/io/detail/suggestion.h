/// \file
/// "Did you mean": the known names nearest to a misspelt one.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet::detail {

/// Insertions, deletions, replacements and swaps of neighbours that turn a into b (optimal string alignment).
/// Method: F. J. Damerau, "A technique for computer detection and correction of spelling errors", CACM 7(3), 1964.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidates nearest to the word, all those at the same distance; none when even the nearest is far. Case,
/// hyphens, underscores and blanks count nothing, so that timeStep is next to time_step.
[[nodiscard]] std::vector<std::string_view> nearest_names(std::string_view word,
                                                          const std::vector<std::string_view>& candidates);

/// `did you mean "a" or "b"?`; empty without names.
[[nodiscard]] std::string did_you_mean(const std::vector<std::string_view>& names);

/// `"a", "b", "c"`
[[nodiscard]] std::string quoted_list(const std::vector<std::string_view>& names);

}  // namespace ricochet::detail
