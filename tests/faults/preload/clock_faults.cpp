// Makes the clocks of a program jump. Preloaded with LD_PRELOAD, on Linux.
//
// RICOCHET_FAULT_CLOCK is the seed of the jumps. Every few calls, all clocks for the time of day or the uptime jump
// forwards or backwards by up to some hours. The same seed gives the same jumps.
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>

namespace {

constexpr std::uint64_t kCallsBetweenJumps = 3;
constexpr std::int64_t kLargestJump = 20000;  // in s
constexpr std::int64_t kNanoseconds = 1'000'000'000;

std::atomic<std::uint64_t> calls{0};

// Mixes bits like SplitMix64, after D. Stafford's mixing functions.
std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31U);
}

// Returns the current error of all clocks, in ns. It is 0 if the environment does not request jumps.
std::int64_t error_now() {
    static const char* const text = std::getenv("RICOCHET_FAULT_CLOCK");
    if (text == nullptr) return 0;
    static const std::uint64_t seed = std::strtoull(text, nullptr, 10);
    const std::uint64_t random = mixed(seed * 1000003 + calls++ / kCallsBetweenJumps);
    // A third of the jumps are shorter than a second, so that small errors are tested too.
    const std::int64_t unit = random % 3 == 0 ? 1 : kNanoseconds;
    const std::int64_t range = random % 3 == 0 ? kNanoseconds : kLargestJump;
    return unit * (static_cast<std::int64_t>((random >> 8U) % static_cast<std::uint64_t>(2 * range)) - range);
}

void shift(timespec& time) {
    const std::int64_t sum = time.tv_sec * kNanoseconds + time.tv_nsec + error_now();
    const std::int64_t positive = sum < 0 ? 0 : sum;
    time.tv_sec = positive / kNanoseconds;
    time.tv_nsec = positive % kNanoseconds;
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
    if (::syscall(SYS_clock_gettime, clock, time) != 0) return -1;
    shift(*time);
    return 0;
}

extern "C" int gettimeofday(timeval* __restrict time, void* __restrict) noexcept {
    timespec now{};
    if (clock_gettime(CLOCK_REALTIME, &now) != 0) return -1;
    time->tv_sec = now.tv_sec;
    time->tv_usec = now.tv_nsec / 1000;
    return 0;
}

extern "C" time_t time(time_t* result) noexcept {
    timespec now{};
    (void)clock_gettime(CLOCK_REALTIME, &now);
    if (result != nullptr) *result = now.tv_sec;
    return now.tv_sec;
}
