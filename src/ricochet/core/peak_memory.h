/// \file
/// How much memory the process has used at most.
#pragma once

#include <cstdint>

namespace ricochet {

/// Largest resident set of this process so far, bytes.
[[nodiscard]] std::uint64_t peak_memory_bytes();

}  // namespace ricochet
