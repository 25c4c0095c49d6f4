#include "mpi/common_memory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "ricochet/core/error.h"

namespace ricochet::mpi {
namespace {

class File {
public:
    explicit File(int number) : number_(number) {}
    ~File() {
        if (number_ >= 0) (void)::close(number_);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    [[nodiscard]] int number() const { return number_; }

private:
    int number_;
};

bool write_all(int file, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ::ssize_t written = ::write(file, bytes.data(), bytes.size());
        if (written <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
}

/// Returns the descriptor of a file in memory with these bytes, or -1 if memory is short. The file has no name in any
/// folder. The system therefore deletes it with the last process that maps it, even if that process crashes.
int file_of(std::span<const std::byte> bytes) {
    const int file = ::memfd_create("ricochet", MFD_CLOEXEC);
    if (file < 0 || write_all(file, bytes)) return file;
    (void)::close(file);
    return -1;
}

/// Returns the mapped pages of the file, or null if they cannot be mapped.
void* mapped(int file, std::size_t size) {
    if (file < 0) return nullptr;
    void* const pages = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file, 0);
    return pages == MAP_FAILED ? nullptr : pages;
}

/// Replaces equal pages of the ranks by shared pages. Returns false if the pages cannot be shared. Works in two steps,
/// so that every rank has mapped the shared pages before any rank drops its own pages. The first rank keeps its file
/// open until all ranks have opened it.
bool have_in_common(std::span<const std::byte> list, const Neighbours& here) {
    const bool is_first = here.is_first();
    const File own(is_first ? file_of(list) : -1);
    std::array<std::int64_t, 3> told{::getpid(), own.number(), static_cast<std::int64_t>(list.size())};
    here.tell(told);
    if (told[1] < 0) return false;
    const auto size = static_cast<std::size_t>(told[2]);
    // The file has no name, so it is opened through the descriptor of the first rank's process.
    const File other(is_first ? -1
                              : ::open(fmt::format("/proc/{}/fd/{}", told[0], told[1]).c_str(), O_RDONLY | O_CLOEXEC));
    void* const pages = mapped(is_first ? own.number() : other.number(), size);
    const bool is_alike =
        list.size() == size && (is_first || pages == nullptr || std::memcmp(pages, list.data(), size) == 0);
    const bool are_alike = here.all(is_alike);
    const bool have_all = here.all(pages != nullptr);
    if (are_alike && have_all) {
        void* const place = const_cast<std::byte*>(list.data());
        const bool is_there = ::mremap(pages, size, size, MREMAP_MAYMOVE | MREMAP_FIXED, place) != MAP_FAILED;
        if (here.all(is_there)) return true;
        throw RunError("ranks: memory for the meshes is short");  // the old pages may already be unmapped
    }
    if (pages != nullptr) (void)::munmap(pages, size);
    if (!are_alike) throw RunError("ranks: the meshes of processes on this machine differ, expected the same files");
    return false;
}

}  // namespace

std::uint64_t have_in_common(std::span<const std::span<const std::byte>> pages, const Neighbours& here) {
    std::uint64_t bytes = 0;
    if (here.size() < 2) return bytes;
    for (const auto list : pages) bytes += have_in_common(list, here) ? list.size() : 0;
    return bytes;
}

}  // namespace ricochet::mpi
