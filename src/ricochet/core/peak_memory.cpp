#include "ricochet/core/peak_memory.h"

#include <sys/resource.h>

namespace ricochet {

std::uint64_t peak_memory_bytes() {
    rusage usage{};
    if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024U;  // Linux counts in kilobytes
}

}  // namespace ricochet
