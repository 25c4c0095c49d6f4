#include "ricochet/core/normal_quantile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "ricochet/core/portable_math.h"

namespace ricochet {
namespace {

// Numerators and denominators of the three rational functions of AS 241, from the constant term on. Local: constants of
// the method.
using Terms = std::array<double, 8>;
constexpr Terms kA{3.3871328727963666080e0,  1.3314166789178437745e+2, 1.9715909503065514427e+3,
                   1.3731693765509461125e+4, 4.5921953931549871457e+4, 6.7265770927008700853e+4,
                   3.3430575583588128105e+4, 2.5090809287301226727e+3};
constexpr Terms kB{1.0,
                   4.2313330701600911252e+1,
                   6.8718700749205790830e+2,
                   5.3941960214247511077e+3,
                   2.1213794301586595867e+4,
                   3.9307895800092710610e+4,
                   2.8729085735721942674e+4,
                   5.2264952788528545610e+3};
constexpr Terms kC{1.42343711074968357734e0,  4.63033784615654529590e0, 5.76949722146069140550e0,
                   3.64784832476320460504e0,  1.27045825245236838258e0, 2.41780725177450611770e-1,
                   2.27238449892691845833e-2, 7.74545014278341407640e-4};
constexpr Terms kD{1.0,
                   2.05319162663775882187e0,
                   1.67638483018380384940e0,
                   6.89767334985100004550e-1,
                   1.48103976427480074590e-1,
                   1.51986665636164571966e-2,
                   5.47593808499534494600e-4,
                   1.05075007164441684324e-9};
constexpr Terms kE{6.65790464350110377720e0,  5.46378491116411436990e0,  1.78482653991729133580e0,
                   2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                   2.71155556874348757815e-5, 2.01033439929228813265e-7};
constexpr Terms kF{1.0,
                   5.99832206555887937690e-1,
                   1.36929880922735805310e-1,
                   1.48753612908506148525e-2,
                   7.86869131145613259100e-4,
                   1.84631831751005468180e-5,
                   1.42151175831644588870e-7,
                   2.04426310338993978564e-15};

double ratio(const Terms& above, const Terms& below, double x) {
    double numerator = 0.0;
    double denominator = 0.0;
    for (std::size_t n = above.size(); n > 0; --n) {
        numerator = numerator * x + above[n - 1];
        denominator = denominator * x + below[n - 1];
    }
    return numerator / denominator;
}

}  // namespace

double normal_quantile(double p) {
    const double q = p - 0.5;
    if (std::fabs(q) <= 0.425) return q * ratio(kA, kB, 0.180625 - q * q);
    const double r = std::sqrt(-portable_log(std::min(p, 1.0 - p)));
    const double size = r <= 5.0 ? ratio(kC, kD, r - 1.6) : ratio(kE, kF, r - 5.0);
    return q < 0.0 ? -size : size;
}

// Positive numbers have the order of their bits, so the bisection finds small probabilities with full relative
// accuracy.
double normal_cumulative(double x) {
    if (std::isnan(x)) return x;
    if (x > 0.0) return 1.0 - normal_cumulative(-x);
    std::uint64_t lower = 0;
    std::uint64_t upper = std::bit_cast<std::uint64_t>(0.5);
    while (upper - lower > 1) {
        const std::uint64_t middle = lower + (upper - lower) / 2;
        (normal_quantile(std::bit_cast<double>(middle)) < x ? lower : upper) = middle;
    }
    return std::bit_cast<double>(x == 0.0 ? upper : lower);
}

double normal_of_uniform(double u) {
    if (u < 0.5) return normal_quantile(u + 0x1p-54);
    return -normal_quantile((1.0 - u) - 0x1p-54);
}

}  // namespace ricochet
