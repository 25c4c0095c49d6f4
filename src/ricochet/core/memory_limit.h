/// \file
/// Amount of memory that this process may allocate, determined before the allocation.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace ricochet {

/// Smallest of the memory limits of this process.
struct MemoryLimit {
    double bytes = 0.0;       ///< number that the process may still allocate; infinity if no limit is known
    std::string_view source;  ///< name of the limit, for messages
};

/// Folders in which the kernel reports memory and its limits.
struct MemoryFiles {
    std::filesystem::path process = "/proc/self";
    std::filesystem::path system = "/proc";
    std::filesystem::path control_groups = "/sys/fs/cgroup";
};

/// Returns the smallest of these limits:
/// - The limit of the control group of the process and of its ancestors. Version 2 stores it in `memory.max`, and the
///   line "0::" of /proc/self/cgroup names the group. Version 1 stores it in `memory.limit_in_bytes`, and the line with
///   the controller "memory" names the group. The memory of other processes in the group is not subtracted, because
///   most of it is usually cache. Sources: the Linux kernel's Documentation/admin-guide/cgroup-v2.rst and
///   cgroup-v1/memory.rst.
/// - RLIMIT_AS less the address space in use, and RLIMIT_DATA less the data in use (getrlimit(2); /proc/self/statm, see
///   proc(5)).
/// - The sum of MemAvailable and SwapFree of /proc/meminfo, which programs can allocate before the kernel kills a
///   process, see proc(5). If that file is missing, the physical memory (sysconf(3)) counts instead.
///
/// The limit decides only whether a request is refused, and never changes a result.
[[nodiscard]] MemoryLimit memory_limit(const MemoryFiles& files = {});

/// Returns a number of bytes as text, in powers of 1000: 12 MB, 1.53 GB.
[[nodiscard]] std::string memory_text(double bytes);

/// Returns the message for a request above the limit: "asks for about 36 GB of memory, expected at most 8 GB (...)".
[[nodiscard]] std::string too_much_memory(double bytes, const MemoryLimit& limit);

/// Throws InputError "NAME: asks for ..." if the number of bytes exceeds memory_limit().
void require_memory(double bytes, std::string_view what);

}  // namespace ricochet
