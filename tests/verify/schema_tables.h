/// \file
/// How likely and how large the values of random scenes are, by the keys of the scene schema. An owner is a definition
/// of the schema, with its type in brackets for a definition of several types.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace ricochet::test {

/// A range of numbers that are drawn.
struct Range {
    enum class Unit : std::uint8_t { plain, logarithm, of_duration, per_duration };
    double low = 0.0;
    double high = 1.0;
    Unit unit = Unit::plain;
};

/// Returns the range of a number, if the key has one of its own.
[[nodiscard]] std::optional<Range> range_of(const std::string& owner, const std::string& key);
/// Returns the probability with which an optional key is drawn.
[[nodiscard]] double probability_of(const std::string& owner, const std::string& key);

}  // namespace ricochet::test
