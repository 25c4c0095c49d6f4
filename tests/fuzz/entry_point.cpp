// Entry point of libFuzzer for one target, RICOCHET_FUZZ_TARGET.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <ctime>

#include "fuzz/fuzz_targets.h"

namespace {

/// Returns the largest processor time of an input, in s. The environment can raise it, so that long runs skip slow
/// inputs. libFuzzer's own limit is in wall-clock time, which also counts other programs.
double most_time() {
    const char* text = std::getenv("RICOCHET_FUZZ_TIME");  // NOLINT(concurrency-mt-unsafe): no code sets it
    return text == nullptr ? 2.0 : std::strtod(text, nullptr);
}

double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

// An exception ends the fuzzer, which then saves the input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {  // NOLINT(readability-identifier-naming)
    const double begin = processor_time();
    static_cast<void>(ricochet::fuzz::RICOCHET_FUZZ_TARGET({reinterpret_cast<const char*>(data), size}));
    ricochet::fuzz::require(processor_time() - begin <= most_time(), "an input takes no more than its time");
    return 0;
}
