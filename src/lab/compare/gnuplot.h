// Pictures through the gnuplot program.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet {

// The common style of the pictures that gnuplot draws for reports.

/// The beginning of a script: terminal, grid, borders, key. A variable `ending` set before it is to be appended to the
/// names of the pictures. remark: one line, what the script draws and how it is run.
[[nodiscard]] std::string gnuplot_start(std::string_view remark);

/// Defines line styles 1 to count: colours that the colour-blind tell apart, and points of different forms, those of
/// the first larger, so that equal points show all.
[[nodiscard]] std::string gnuplot_line_styles(std::size_t count);

/// Runs a script in its folder and waits. The script must put the variable `ending` behind the names of the pictures
/// that it writes; they appear under their own names only when all are complete. Returns why there are no pictures:
/// empty, or one line (not installed, gnuplot's own words, stopped). should_stop: asked while waiting. Nothing is left
/// behind either when a signal ends the process (core/unfinished_file.h).
[[nodiscard]] std::string draw_with_gnuplot(
    const std::filesystem::path& folder, const std::string& script, const std::vector<std::string>& pictures,
    const std::function<bool()>& should_stop = [] { return false; });

}  // namespace ricochet
