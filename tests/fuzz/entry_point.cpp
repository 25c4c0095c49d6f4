// libFuzzer's entry point for one target, RICOCHET_FUZZ_TARGET.
#include <cstddef>
#include <cstdint>

#include "fuzz/fuzz_targets.h"

// What a target throws ends the fuzzer, which then keeps the input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {  // NOLINT(readability-identifier-naming)
    static_cast<void>(ricochet::fuzz::RICOCHET_FUZZ_TARGET({reinterpret_cast<const char*>(data), size}));
    return 0;
}
