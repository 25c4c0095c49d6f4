// Pictures through the gnuplot program.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace ricochet::cli {

/// Runs a script in its folder and waits. The script must put the variable `ending` behind the names of the pictures
/// that it writes; they appear under their own names only when all are complete. Returns why there are no pictures:
/// empty, or one line (not installed, gnuplot's own words, stopped). should_stop: asked while waiting.
[[nodiscard]] std::string draw_with_gnuplot(const std::filesystem::path& folder, const std::string& script,
                                            const std::vector<std::string>& pictures,
                                            const std::function<bool()>& should_stop);

}  // namespace ricochet::cli
