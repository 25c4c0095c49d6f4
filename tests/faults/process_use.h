/// \file Resources that this process uses.
#pragma once

#include <malloc.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace ricochet::test {

/// Returns the resident memory in bytes, after free memory has been released.
[[nodiscard]] inline std::size_t resident_bytes() {
    (void)::malloc_trim(0);
    std::ifstream in("/proc/self/statm");
    std::size_t pages = 0;
    std::size_t resident = 0;
    in >> pages >> resident;
    return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// Returns the number of entries of a folder of /proc. The folder "self/fd" lists open files, and "self/task" lists
/// threads.
[[nodiscard]] inline std::size_t count_in_proc(const char* folder) {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(std::filesystem::path("/proc") / folder), {}));
}

}  // namespace ricochet::test
