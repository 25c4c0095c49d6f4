#include "generators/require.h"

#include <fmt/format.h>

#include "ricochet/core/error.h"

namespace ricochet::meshes {
namespace {

template <typename Number>
void require(std::string_view shape, std::string_view option, Number value, Number lowest, Number highest) {
    if (value >= lowest && value <= highest) return;
    throw InputError(fmt::format("{}: --{} must be between {} and {}, got {}", shape, option, lowest, highest, value));
}

}  // namespace

void require_between(std::string_view shape, std::string_view option, double value, double lowest, double highest) {
    require(shape, option, value, lowest, highest);
}

void require_between(std::string_view shape, std::string_view option, int value, int lowest, int highest) {
    require(shape, option, value, lowest, highest);
}

void require_length(std::string_view shape, std::string_view option, double value) {
    require(shape, option, value, kShortest, kLongest);
}

}  // namespace ricochet::meshes
