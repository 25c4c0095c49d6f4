/// \file
/// Means and their standard errors, for tests that compare random quantities with expected values.
#pragma once

#include <cmath>
#include <cstddef>

namespace ricochet::testing {

/// Independent draws of one quantity.
class Sample {
public:
    void add(double value) {
        ++count_;
        const double before = value - mean_;
        mean_ += before / static_cast<double>(count_);
        squares_ += before * (value - mean_);
    }
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] double mean() const { return mean_; }
    /// Returns the standard error of the mean.
    [[nodiscard]] double error() const {
        const auto n = static_cast<double>(count_);
        return count_ < 2 ? INFINITY : std::sqrt(squares_ / (n - 1.0) / n);
    }

private:
    std::size_t count_ = 0;
    double mean_ = 0.0;
    double squares_ = 0.0;
};

/// Independent pairs (numerator, denominator), for a test that the ratio of the means has an expected value.
class RatioSample {
public:
    explicit RatioSample(double expected) : expected_(expected) {}
    void add(double numerator, double denominator) {
        difference_.add(numerator - expected_ * denominator);
        denominator_.add(denominator);
        numerator_.add(numerator);
    }
    [[nodiscard]] double ratio() const { return numerator_.mean() / denominator_.mean(); }
    /// Returns the standard error of the ratio under the assumption that the expected value is true.
    [[nodiscard]] double error() const { return difference_.error() / denominator_.mean(); }

private:
    double expected_;
    Sample difference_;
    Sample numerator_;
    Sample denominator_;
};

}  // namespace ricochet::testing
