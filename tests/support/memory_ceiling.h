/// \file
/// A limit on the memory of this process and of those that it starts, so that what would take too much is seen to be
/// refused before it takes it.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace ricochet::test {

/// While it lives, this process may take only so many bytes more, and one that it starts so many beside what this one
/// holds (RLIMIT_DATA).
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
