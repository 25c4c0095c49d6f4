#include "ricochet/core/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "ricochet/core/error.h"

namespace ricochet {
namespace {

// Returns a temporary name that no other writer of the same file uses, in this process or in another.
std::filesystem::path temporary_name(const std::filesystem::path& target) {
    static std::atomic<unsigned> counter{0};
    std::filesystem::path name = target;
    name += fmt::format(".{}-{}.partial", ::getpid(), counter++);
    return name;
}

[[noreturn]] void fail(const std::filesystem::path& target, const char* what) {
    throw RunError(fmt::format("{}: cannot {} the file ({})", target.string(), what, std::strerror(errno)));
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path target)
    : target_(std::move(target)), temporary_(temporary_name(target_)), unfinished_(temporary_) {
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(target_, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        throw InputError(fmt::format("{}: not a regular file, choose another output name", target_.string()));
    }
    file_ = std::fopen(temporary_.c_str(), "wb");
    if (file_ == nullptr) fail(target_, "create");
}

AtomicFile::~AtomicFile() {
    if (file_ != nullptr) (void)std::fclose(file_);
    if (is_committed_) return;
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::write(std::string_view bytes) {
    if (bytes.empty()) return;  // empty data may have a null address, which fwrite does not accept
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail(target_, "write");
}

void AtomicFile::commit() {
    if (std::fflush(file_) != 0) fail(target_, "write");
    // The file is closed before the rename, because some file systems report a failed write only when a file is closed.
    if (std::fclose(std::exchange(file_, nullptr)) != 0) fail(target_, "close");
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail(target_, "name");
    is_committed_ = true;
}

void write_file(const std::filesystem::path& target, std::string_view bytes) {
    AtomicFile file(target);
    file.write(bytes);
    file.commit();
}

}  // namespace ricochet
