/// \file
/// Vector units of processors, for functions that exist in one version for each. All versions compute the same bits.
#pragma once

#include <cstdint>
#include <span>

namespace ricochet {

/// Instruction set of a function's version. A processor that has one of them has all earlier ones.
enum class VectorUnit : std::uint8_t {
    baseline,  ///< of all processors for which the program is built
    avx2,
    avx512,  ///< with vectors of 256 bits (AVX512VL)
};

/// Returns the vector units that this processor has, in ascending order.
[[nodiscard]] std::span<const VectorUnit> vector_units();

}  // namespace ricochet
