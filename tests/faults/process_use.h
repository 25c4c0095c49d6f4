/// \file
/// What this process holds of the machine.
#pragma once

#include <malloc.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace ricochet::test {

/// Bytes of memory that are resident, once what is free has been given back.
[[nodiscard]] inline std::size_t resident_bytes() {
    (void)::malloc_trim(0);
    std::ifstream in("/proc/self/statm");
    std::size_t pages = 0;
    std::size_t resident = 0;
    in >> pages >> resident;
    return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// Entries of a folder of /proc: of "self/fd" the open files, of "self/task" the threads.
[[nodiscard]] inline std::size_t count_in_proc(const char* folder) {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(std::filesystem::path("/proc") / folder), {}));
}

}  // namespace ricochet::test
