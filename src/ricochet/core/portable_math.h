/// \file
/// Exponential, logarithm, power and sine of which every bit is the same on every system: the C library's differ in
/// their last bit. Only additions, multiplications, divisions and exact scalings are used; results are within a few
/// ulp.
#pragma once

namespace ricochet {

/// e^x; 0 below some -745, infinity above some 709.8.
[[nodiscard]] double portable_exp(double x);
/// Natural logarithm; x > 0. -infinity for 0, not a number below.
[[nodiscard]] double portable_log(double x);
/// x^y for x > 0, relative error some 2^-52 (1 + |y log x|).
[[nodiscard]] double portable_pow(double x, double y);
/// Sine of 2 pi turns: whole turns are taken off exactly, so that late times lose nothing.
[[nodiscard]] double sine_of_turns(double turns);

}  // namespace ricochet
