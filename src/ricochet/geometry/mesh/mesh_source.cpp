#include "ricochet/geometry/mesh/mesh_source.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "ricochet/core/error.h"

namespace ricochet {
namespace {

[[noreturn]] void fail_to_open(const std::filesystem::path& path) {
    if (errno == ENOENT || errno == ENOTDIR) {
        throw InputError(fmt::format("{}: no such file, check the name", path.string()));
    }
    throw InputError(fmt::format("{}: cannot be read ({})", path.string(), std::strerror(errno)));
}

void require_regular(const std::filesystem::path& path, const struct stat& status) {
    if (S_ISREG(status.st_mode)) return;
    throw InputError(fmt::format("{}: {}, expected a regular file that holds a mesh", path.string(),
                                 S_ISDIR(status.st_mode) ? "is a folder" : "is a device, pipe or socket"));
}

class FileDescriptor {
public:
    // Non-blocking: should the name become a FIFO after it was checked, opening it must not wait for a writer.
    explicit FileDescriptor(const std::filesystem::path& path)
        : value_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
    ~FileDescriptor() {
        if (value_ >= 0) ::close(value_);
    }
    FileDescriptor(const FileDescriptor&) = delete;
    FileDescriptor& operator=(const FileDescriptor&) = delete;
    [[nodiscard]] int value() const { return value_; }

private:
    int value_;
};

}  // namespace

void MeshSource::fail(const std::string& what) const { throw InputError(fmt::format("{}: {}", name, what)); }

void MeshSource::fail_at_line(std::size_t line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", name, line, what));
}

void MeshSource::fail_at_byte(std::size_t byte, const std::string& what) const {
    throw InputError(fmt::format("{}: byte {}: {}", name, byte, what));
}

FileBytes read_regular_file(const std::filesystem::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) fail_to_open(path);
    require_regular(path, status);
    const FileDescriptor file(path);
    if (file.value() < 0 || ::fstat(file.value(), &status) != 0) fail_to_open(path);
    require_regular(path, status);

    FileBytes bytes;
    bytes.size = static_cast<std::size_t>(status.st_size);
    bytes.data = std::make_unique_for_overwrite<char[]>(bytes.size);
    std::size_t done = 0;
    while (done < bytes.size) {
        const ssize_t count = ::read(file.value(), bytes.data.get() + done, bytes.size - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail_to_open(path);
        if (count == 0) throw InputError(fmt::format("{}: became shorter while it was being read", path.string()));
        done += static_cast<std::size_t>(count);
    }
    return bytes;
}

std::string in_quotes(std::string_view word) {
    constexpr std::size_t kLongest = 40;
    std::string text = "'";
    for (const char c : word.substr(0, kLongest)) text += (c >= ' ' && c <= '~') ? c : '?';
    return text + (word.size() > kLongest ? "...'" : "'");
}

void require_plain_text(const MeshSource& source) {
    if (source.bytes.starts_with("\xff\xfe") || source.bytes.starts_with("\xfe\xff")) {
        source.fail("UTF-16 text, save the file as UTF-8 or ASCII");
    }
    const std::size_t nul = source.bytes.find('\0');
    if (nul != std::string_view::npos) {
        source.fail_at_byte(nul, "NUL byte in a text file, expected text only (is this a binary or UTF-16 file?)");
    }
}

}  // namespace ricochet
