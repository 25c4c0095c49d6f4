#include "fuzz/fuzz_reader.h"
#include "ricochet/geometry/mesh/mesh_source.h"

// libFuzzer's entry point.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {  // NOLINT(readability-identifier-naming)
    return ricochet::fuzz::read(ricochet::read_stl, data, size);
}
