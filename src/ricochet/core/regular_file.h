/// \file
/// Reads whole files that others may have made.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace ricochet {

/// Reads a regular file whole. A pipe would be waited for, and a device may never end: both are refused. Throws
/// InputError, naming the file and `expected`, for these, for a file that cannot be read and for one of more than
/// `most` bytes.
[[nodiscard]] std::string read_regular_file(const std::filesystem::path& file, std::uint64_t most,
                                            const std::string& expected);

}  // namespace ricochet
