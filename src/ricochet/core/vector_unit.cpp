#include "ricochet/core/vector_unit.h"

#include <array>
#include <cstddef>

namespace ricochet {

std::span<const VectorUnit> vector_units() {
    static constexpr std::array kUnits{VectorUnit::baseline, VectorUnit::avx2, VectorUnit::avx512};
#if defined(__x86_64__)
    static const std::size_t count =
        __builtin_cpu_supports("avx512vl") != 0 ? 3 : (__builtin_cpu_supports("avx2") != 0 ? 2 : 1);
#else
    constexpr std::size_t count = 1;
#endif
    return std::span(kUnits).first(count);
}

}  // namespace ricochet
