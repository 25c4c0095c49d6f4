// Drawing of pictures by the program gnuplot.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet {

// Common style of the pictures of reports.

/// Returns the beginning of a script, which sets the terminal, grid, borders and key. The caller must append the
/// gnuplot variable `ending` to the names of the pictures. If this variable is not set before the script runs, it is
/// empty. `remark` is a comment of one line that describes the pictures and the command that draws them.
[[nodiscard]] std::string gnuplot_start(std::string_view remark);

/// Returns definitions of line styles 1 to `count`. Colour-blind readers can distinguish the colours, and the point
/// types differ. The first styles have the largest points and are drawn first, so that coinciding points stay visible.
[[nodiscard]] std::string gnuplot_line_styles(std::size_t count);

/// Runs a script in a folder and waits for its end. The script must append the variable `ending` to the names of the
/// pictures that it writes. When all pictures are complete, they are renamed to their final names. Returns an empty
/// string in case of success. Otherwise returns one line with the reason: gnuplot is not installed, was stopped, or
/// failed. If `should_stop`, which is called during the wait, returns true, gnuplot is stopped. If a signal ends this
/// process, no unfinished files remain (core/unfinished_file.h).
[[nodiscard]] std::string draw_with_gnuplot(
    const std::filesystem::path& folder, const std::string& script, const std::vector<std::string>& pictures,
    const std::function<bool()>& should_stop = [] { return false; });

}  // namespace ricochet
