#include "cli/text_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace ricochet::cli {

void print_table(const std::vector<std::vector<std::string>>& table) {
    std::vector<std::size_t> widths(table.front().size(), 0);
    for (const auto& row : table) {
        for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
    }
    for (const auto& row : table) {
        std::string line = fmt::format("  {:<{}}", row.front(), widths.front());
        for (std::size_t k = 1; k < row.size(); ++k) line += fmt::format("  {:>{}}", row[k], widths[k]);
        fmt::print("{}\n", line);
    }
}

}  // namespace ricochet::cli
