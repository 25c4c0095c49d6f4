// libFuzzer's entry point for one target, RICOCHET_FUZZ_TARGET.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <ctime>

#include "fuzz/fuzz_targets.h"

namespace RICOCHET_FILE {

/// s of processor time that an input may take, unless the environment says otherwise: long runs go on past what is
/// slow. libFuzzer's own limit is of the wall's clock, which also counts what other programs take.
double most_time() {
    const char* text = std::getenv("RICOCHET_FUZZ_TIME");  // NOLINT(concurrency-mt-unsafe): nothing sets it
    return text == nullptr ? 2.0 : std::strtod(text, nullptr);
}

double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace RICOCHET_FILE

// What is thrown here ends the fuzzer, which then keeps the input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {  // NOLINT(readability-identifier-naming)
    const double begin = processor_time();
    static_cast<void>(ricochet::fuzz::RICOCHET_FUZZ_TARGET({reinterpret_cast<const char*>(data), size}));
    ricochet::fuzz::require(processor_time() - begin <= most_time(), "an input takes no more than its time");
    return 0;
}
