/// \file
/// Exponential, logarithm, power and sine with the same bits on every system, unlike those of the C library. Only
/// additions, multiplications, divisions and exact scalings are used; errors are a few ulp.
#pragma once

namespace ricochet {

/// e^x; 0 below some -745, infinity above some 709.8.
[[nodiscard]] double portable_exp(double x);
/// Natural logarithm; x > 0. -infinity for 0, NaN below.
[[nodiscard]] double portable_log(double x);
/// x^y for x > 0, relative error some 2^-52 (1 + |y log x|).
[[nodiscard]] double portable_pow(double x, double y);
/// Sine of 2 pi turns; whole turns are removed exactly, so late times lose no accuracy.
[[nodiscard]] double sine_of_turns(double turns);

/// The angle whose sine and cosine are as these (>= 0), in whole turns: 0 to 1/4. Not both may be 0.
[[nodiscard]] double turns_of(double sine, double cosine);

}  // namespace ricochet
