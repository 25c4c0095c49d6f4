/// \file
/// How the pictures look that gnuplot draws for reports: one look for all of them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace ricochet {

/// The beginning of a script: terminal, grid, borders, key. A variable `ending` set before it is to be appended to the
/// names of the pictures. remark: one line, what the script draws and how it is run.
[[nodiscard]] std::string gnuplot_start(std::string_view remark);

/// Defines line styles 1 to count: colours that the colour-blind tell apart, and points of different forms, those of
/// the first larger, so that equal points show all.
[[nodiscard]] std::string gnuplot_line_styles(std::size_t count);

}  // namespace ricochet
