/// \file
/// Means with their standard errors, for comparisons with expected values of random quantities.
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

/// Independent pairs (numerator, denominator) whose means have the expected ratio.
class RatioSample {
public:
    explicit RatioSample(double expected) : expected_(expected) {}
    void add(double numerator, double denominator) {
        difference_.add(numerator - expected_ * denominator);
        denominator_.add(denominator);
        numerator_.add(numerator);
    }
    [[nodiscard]] double ratio() const { return numerator_.mean() / denominator_.mean(); }
    /// Returns the standard error of the ratio, if the expected value is the true one.
    [[nodiscard]] double error() const { return difference_.error() / denominator_.mean(); }

private:
    double expected_;
    Sample difference_;
    Sample numerator_;
    Sample denominator_;
};

}  // namespace ricochet::testing
