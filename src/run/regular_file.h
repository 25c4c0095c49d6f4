/// \file
/// Reader of whole files from untrusted sources.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace ricochet {

/// Reads a whole regular file. Refuses pipes, because the read would block, and devices, because their data may never
/// end. Throws InputError for these, for unreadable files and for files of more than `most` bytes. The message names
/// the file and `expected`.
[[nodiscard]] std::string read_regular_file(const std::filesystem::path& file, std::uint64_t most,
                                            const std::string& expected);

}  // namespace ricochet
