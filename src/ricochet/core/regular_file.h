/// \file
/// Reader of whole files that may come from outside.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace ricochet {

/// Reads a regular file whole. Refuses pipes, because the read would block, and devices, because they may never end.
/// Throws InputError, naming the file and `expected`, for these, for unreadable files and for files of more than `most`
/// bytes.
[[nodiscard]] std::string read_regular_file(const std::filesystem::path& file, std::uint64_t most,
                                            const std::string& expected);

}  // namespace ricochet
