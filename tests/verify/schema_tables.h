/// \file
/// Probabilities and ranges of the values in random scenes, by the keys of the scene schema. An owner is a definition
/// of the schema; a definition of several types has its type in brackets.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace ricochet::test {

/// A range of drawn numbers.
struct Range {
    enum class Unit : std::uint8_t { plain, logarithm, of_duration, per_duration };
    double low = 0.0;
    double high = 1.0;
    Unit unit = Unit::plain;
};

/// Returns the range of a number, if the key has its own.
[[nodiscard]] std::optional<Range> range_of(const std::string& owner, const std::string& key);
/// Returns the probability with which an optional key is drawn.
[[nodiscard]] double probability_of(const std::string& owner, const std::string& key);

}  // namespace ricochet::test
