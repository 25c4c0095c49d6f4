/// \file
/// Limit on the memory of this process and its child processes. Tests use it to show that excessive requests are
/// refused before memory is allocated.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace ricochet::test {

/// Limits memory (RLIMIT_DATA) during the lifetime of the object. This process may allocate the given bytes beyond its
/// current use. Its child processes have the same absolute limit.
class MemoryCeiling {
public:
    explicit MemoryCeiling(double bytes) {
        (void)::getrlimit(RLIMIT_DATA, &before_);
        double pages = 0.0;
        std::ifstream statm("/proc/self/statm");
        for (int k = 0; k < 6; ++k) statm >> pages;
        rlimit lowered = before_;
        lowered.rlim_cur = static_cast<rlim_t>(pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) + bytes);
        (void)::setrlimit(RLIMIT_DATA, &lowered);
    }
    ~MemoryCeiling() { (void)::setrlimit(RLIMIT_DATA, &before_); }
    MemoryCeiling(const MemoryCeiling&) = delete;
    MemoryCeiling& operator=(const MemoryCeiling&) = delete;

private:
    rlimit before_{};
};

}  // namespace ricochet::test
