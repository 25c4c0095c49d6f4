// Draws pictures with the gnuplot program.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet {

// The common style of the pictures that gnuplot draws for reports.

/// Returns the beginning of a script: terminal, grid, borders and key. The caller must append the gnuplot variable
/// `ending` to the names of the pictures. It is empty unless it is set before the script runs. `remark` is one line
/// that describes the pictures and the command that draws them.
[[nodiscard]] std::string gnuplot_start(std::string_view remark);

/// Returns definitions of line styles 1 to `count`. Their colours are distinct for colour-blind readers, and their
/// points have different forms. Earlier styles have larger points, so that coinciding points stay visible.
[[nodiscard]] std::string gnuplot_line_styles(std::size_t count);

/// Runs a script in its folder and waits for its end. The script must append the variable `ending` to the names of the
/// pictures that it writes. They get their own names only when all are complete. Returns an empty string, or one line
/// that explains why there are no pictures: gnuplot is not installed, was stopped, or failed with a message.
/// `should_stop` is called during the wait. No files remain if a signal ends the process (core/unfinished_file.h).
[[nodiscard]] std::string draw_with_gnuplot(
    const std::filesystem::path& folder, const std::string& script, const std::vector<std::string>& pictures,
    const std::function<bool()>& should_stop = [] { return false; });

}  // namespace ricochet
