/// \file
/// Standard normal distribution with the same bits on every system.
#pragma once

namespace ricochet {

/// Returns the value that a standard normal number is below with probability p, 0 < p < 1. Relative error: about 1e-15.
/// Method: M. J. Wichura, "Algorithm AS 241: The Percentage Points of the Normal Distribution", Applied Statistics
/// 37(3), 1988, routine PPND16.
[[nodiscard]] double normal_quantile(double p);
/// Returns the probability that a standard normal number is below x; for x > 0 use 1 - normal_cumulative(-x). It is the
/// inverse of normal_quantile(). 0 below about -37.5.
[[nodiscard]] double normal_cumulative(double x);
/// Returns the standard normal number for a uniform number u in [0, 1) with 53 bits. Each u stands for the middle of
/// its interval of 2^-53, so the numbers are symmetric about 0 and smaller than 8.3.
[[nodiscard]] double normal_of_uniform(double u);

}  // namespace ricochet
