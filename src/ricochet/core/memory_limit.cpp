#include "ricochet/core/memory_limit.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <limits>
#include <optional>

#include "ricochet/core/error.h"

namespace ricochet {
namespace {

/// Smallest value, in bytes, of a group's limit that means "no limit". Version 1 of cgroup reports "no limit" as the
/// largest multiple of the page size. Local: a convention of the operating system.
constexpr double kNoGroupLimit = 0x1p60;
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

std::optional<double> number_of(std::string_view text) {
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{}) return std::nullopt;
    return static_cast<double>(value);
}

/// Returns the first number of a file, or nothing if there is none ("max").
std::optional<double> number_in(const std::string& file) {
    std::string word;
    std::ifstream(file) >> word;
    return number_of(word);
}

/// Returns the least limit of a group and its ancestors. In a container the folder of the group can be invisible. The
/// root of the mount may then be that group. group: begins with a slash. Uses strings instead of paths, because
/// libstdc++ 12 frees memory twice if memory runs out while paths are joined.
double group_limit(const std::string& mount, std::string group, const std::string& file) {
    double least = kUnlimited;
    for (;; group.erase(group.rfind('/'))) {
        while (group.ends_with('/')) group.pop_back();
        const std::optional<double> limit = number_in(mount + group + file);
        if (limit && *limit < kNoGroupLimit) least = std::min(least, *limit);
        if (group.find('/') == std::string::npos) return least;
    }
}

/// Returns the least limit of the groups of the process. Lines of the file are "number:controllers:group"; version 2
/// leaves the controllers empty.
double limit_of_groups(const MemoryFiles& files) {
    double least = kUnlimited;
    std::ifstream groups(files.process / "cgroup");
    for (std::string line; std::getline(groups, line);) {
        const std::size_t first = line.find(':');
        const std::size_t second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const std::string group = line.substr(second + 1);
        const std::string& mount = files.control_groups.native();
        if (controllers.empty()) {
            least = std::min(least, group_limit(mount, group, "/memory.max"));
            least = std::min(least, group_limit(mount + "/unified", group, "/memory.max"));
        } else if (("," + controllers + ",").find(",memory,") != std::string::npos) {
            least = std::min(least, group_limit(mount + "/memory", group, "/memory.limit_in_bytes"));
        }
    }
    return least;
}

/// Returns the numbers of memory pages in use, by the whole address space and by data.
std::array<double, 2> pages_in_use(const MemoryFiles& files) {
    std::ifstream statm(files.process / "statm");
    std::array<double, 6> pages{};
    for (double& count : pages) statm >> count;
    return {pages[0], pages[5]};
}

double limit_of_resource(__rlimit_resource resource, double pages_used) {
    rlimit limit{};
    if (::getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
    const double used = pages_used * static_cast<double>(::sysconf(_SC_PAGESIZE));
    return std::max(0.0, static_cast<double>(limit.rlim_cur) - used);
}

/// Returns the available memory of the machine, in bytes. Lines of the file look like "MemAvailable: 16203452 kB".
double memory_of_machine(const MemoryFiles& files) {
    double available = 0.0;
    bool is_known = false;
    std::ifstream info(files.system / "meminfo");
    for (std::string line; std::getline(info, line);) {
        for (const std::string_view key : {"MemAvailable:", "SwapFree:"}) {
            if (!line.starts_with(key)) continue;
            const std::size_t digits = line.find_first_of("0123456789");
            if (digits == std::string::npos) continue;
            available += 1024.0 * number_of(std::string_view(line).substr(digits)).value_or(0.0);
            is_known = is_known || key.starts_with("Mem");
        }
    }
    if (is_known) return available;
    const auto pages = static_cast<double>(::sysconf(_SC_PHYS_PAGES));
    return pages > 0.0 ? pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) : kUnlimited;
}

}  // namespace

MemoryLimit memory_limit(const MemoryFiles& files) {
    const auto [all, data] = pages_in_use(files);
    const std::array limits{
        MemoryLimit{memory_of_machine(files), "the free memory of the machine"},
        MemoryLimit{limit_of_groups(files), "the limit of its control group"},
        MemoryLimit{limit_of_resource(RLIMIT_AS, all), "the rest of `ulimit -v`"},
        MemoryLimit{limit_of_resource(RLIMIT_DATA, data), "the rest of `ulimit -d`"},
    };
    return *std::min_element(limits.begin(), limits.end(),
                             [](const MemoryLimit& a, const MemoryLimit& b) { return a.bytes < b.bytes; });
}

std::string memory_text(double bytes) {
    constexpr std::array kUnits{"kB", "MB", "GB", "TB", "PB", "EB"};
    if (bytes < 1000.0) return fmt::format("{:.0f} B", bytes);
    std::size_t unit = 0;
    double value = bytes / 1000.0;
    for (; value >= 999.5 && unit + 1 < kUnits.size(); ++unit) value /= 1000.0;
    return fmt::format("{:.3g} {}", value, kUnits[unit]);
}

std::string too_much_memory(double bytes, const MemoryLimit& limit) {
    return fmt::format("asks for about {} of memory, expected at most {} ({})", memory_text(bytes),
                       memory_text(limit.bytes), limit.source);
}

void require_memory(double bytes, std::string_view what) {
    const MemoryLimit limit = memory_limit();
    if (bytes > limit.bytes) throw InputError(fmt::format("{}: {}", what, too_much_memory(bytes, limit)));
}

}  // namespace ricochet
