/// \file
/// Exponential, logarithm, power and sine with the same bits on every system, unlike the C library. They use
/// only additions, multiplications, divisions and exact scalings; errors are a few ulp.
#pragma once

namespace ricochet {

/// Returns e^x; 0 below about -745, infinity above about 709.8.
[[nodiscard]] double portable_exp(double x);
/// Returns the natural logarithm; -infinity for 0, NaN below 0.
[[nodiscard]] double portable_log(double x);
/// Returns x^y for x > 0, with a relative error of about 2^-52 (1 + |y log x|).
[[nodiscard]] double portable_pow(double x, double y);
/// Returns the sine of 2 pi turns. Whole turns are removed exactly, so large arguments lose no accuracy.
[[nodiscard]] double sine_of_turns(double turns);

/// Returns the angle with the given sine and cosine (both >= 0), in whole turns from 0 to 1/4. They must not both be 0.
[[nodiscard]] double turns_of(double sine, double cosine);

}  // namespace ricochet
