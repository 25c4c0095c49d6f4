/// \file
/// Mean and standard deviation of numbers that are added one by one.
#pragma once

#include <cmath>
#include <cstdint>

namespace ricochet {

/// Mean and standard deviation. The result depends on the order of the numbers, by rounding.
/// Method: B. P. Welford, "Note on a Method for Calculating Corrected Sums of Squares and Products", Technometrics 4,
/// 1962. It has no cancellation.
struct RunningMean {
    std::uint64_t count = 0;
    double mean = 0.0;     ///< 0 without numbers
    double squares = 0.0;  ///< sum of the squared differences from the mean

    void add(double value) {
        ++count;
        const double difference = value - mean;
        mean += difference / static_cast<double>(count);
        squares += difference * (value - mean);
    }
    /// Returns the standard deviation of the sample, with the divisor count - 1; 0 for fewer than two numbers.
    [[nodiscard]] double deviation() const {
        return count < 2 ? 0.0 : std::sqrt(squares / static_cast<double>(count - 1));
    }
    /// Saves or restores the sums. a: an archive, which is called with each member.
    template <class Archive>
    void archive(Archive& a) {
        a(count), a(mean), a(squares);
    }
    /// Returns true if a sum of these numbers can have been computed.
    [[nodiscard]] bool is_sound() const { return std::isfinite(mean) && squares >= 0.0 && std::isfinite(squares); }
};

}  // namespace ricochet
