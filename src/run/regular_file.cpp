#include "run/regular_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"

namespace ricochet {

std::string read_regular_file(const std::filesystem::path& file, std::uint64_t most, const std::string& expected) {
    const auto refuse = [&](const std::string& what) {
        throw InputError(fmt::format("{}: {}, expected {}", file.string(), what, expected));
    };
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) refuse("is not a regular file");
    const std::uintmax_t size = error ? 0 : std::filesystem::file_size(file, error);
    if (error) refuse(fmt::format("cannot be read ({})", error.message()));
    if (size > most) refuse(fmt::format("has {} bytes, more than {}", size, most));
    require_memory(static_cast<double>(size), file.string());
    std::ifstream in(file, std::ios::binary);
    if (!in) refuse(fmt::format("cannot be read ({})", std::strerror(errno)));
    std::string bytes(static_cast<std::size_t>(size), '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (in.bad()) refuse("cannot be read to its end");
    bytes.resize(static_cast<std::size_t>(in.gcount()));
    return bytes;
}

}  // namespace ricochet
