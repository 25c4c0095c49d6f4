/// \file
/// How much memory this process may take, found out before it is taken.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace ricochet {

/// The least of what limits the memory of this process.
struct MemoryLimit {
    double bytes = 0.0;       ///< that it may take from now on; infinite where nothing is known
    std::string_view source;  ///< which limit that is, in words for a message
};

/// Where the kernel tells about memory: folders of its own file systems.
struct MemoryFiles {
    std::filesystem::path process = "/proc/self";
    std::filesystem::path system = "/proc";
    std::filesystem::path control_groups = "/sys/fs/cgroup";
};

/// The smallest of:
/// - what the control group of the process and those above it may hold: `memory.max` of version 2 (the line "0::" of
///   /proc/self/cgroup names the group), `memory.limit_in_bytes` of version 1 (the line with the controller "memory").
///   What other processes of the group hold is not taken off: most of it is usually cache. Sources: the Linux kernel's
///   Documentation/admin-guide/cgroup-v2.rst and cgroup-v1/memory.rst.
/// - RLIMIT_AS less the address space in use, RLIMIT_DATA less the data in use (getrlimit(2); /proc/self/statm, see
///   proc(5)).
/// - MemAvailable and SwapFree of /proc/meminfo together: what programs can be given without any being killed, see
///   proc(5); where there is no such file, the physical memory (sysconf(3)).
///
/// It decides only whether something is refused, never a result.
[[nodiscard]] MemoryLimit memory_limit(const MemoryFiles& files = {});

/// A number of bytes as people say it, in powers of 1000: 12 MB, 1.53 GB.
[[nodiscard]] std::string memory_text(double bytes);

/// The sentence for what asks for more than it may have: "asks for about 36 GB of memory, expected at most 8 GB (...)".
[[nodiscard]] std::string too_much_memory(double bytes, const MemoryLimit& limit);

/// Throws InputError "what: asks for ..." where that many bytes are more than memory_limit().
void require_memory(double bytes, std::string_view what);

}  // namespace ricochet
