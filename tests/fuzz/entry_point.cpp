// libFuzzer's entry point for one target, RICOCHET_FUZZ_TARGET.
#include <cstddef>
#include <cstdint>
#include <ctime>

#include "fuzz/fuzz_targets.h"

namespace {

/// s of processor time that an input may take. libFuzzer's own limit is of the wall's clock, which also counts what
/// other programs take.
constexpr double kMostTime = 2.0;

double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

// What is thrown here ends the fuzzer, which then keeps the input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {  // NOLINT(readability-identifier-naming)
    const double begin = processor_time();
    static_cast<void>(ricochet::fuzz::RICOCHET_FUZZ_TARGET({reinterpret_cast<const char*>(data), size}));
    ricochet::fuzz::require(processor_time() - begin <= kMostTime, "an input takes no more than 2 s");
    return 0;
}
