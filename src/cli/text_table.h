// Tables on standard output.
#pragma once

#include <string>
#include <vector>

namespace ricochet::cli {

/// A header and rows of as many cells each: the first column to the left, numbers to the right.
void print_table(const std::vector<std::vector<std::string>>& table);

}  // namespace ricochet::cli
