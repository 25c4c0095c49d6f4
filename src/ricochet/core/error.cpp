#include "ricochet/core/error.h"

#include <fmt/format.h>

namespace ricochet::detail {

void refuse_index(std::size_t index, std::size_t size, const char* what) {
    if (size == 0) throw InputError(fmt::format("{}: found {}, but there is none to choose from", what, index));
    throw InputError(fmt::format("{}: found {}, expected a number below {}", what, index, size));
}

void refuse_length(std::size_t found, std::size_t expected, const char* what) {
    throw InputError(fmt::format("{}: found {} entries, expected {}", what, found, expected));
}

}  // namespace ricochet::detail
