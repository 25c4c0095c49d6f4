#include "ricochet/dynamics/heat.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ricochet/core/portable_math.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Stefan-Boltzmann constant, in W/(m^2 K^4) (exact by the SI of 2019).
constexpr double kStefanBoltzmann = 5.670374419e-8;

/// Upper limit of the start difference to the ambient temperature, as a multiple of (3 b t)^(-1/3). After a time t,
/// even an arbitrarily hot body is less than (3 b t)^(-1/3) above the ambient temperature. Clamping the start
/// difference to this limit therefore does not change any digit of the result. Local: a limit whose effect is far below
/// the last digit.
constexpr double kStartDifferenceLimit = 1e6;

/// e^-x is 0 in double precision for x above this value. Local: a limit from the range of doubles.
constexpr double kUnderflowExponent = 750.0;

/// Decay of the difference d = T - Ta: d' = -g d with g = a + b (T^2 + Ta^2) (T + Ta). The integrated variable is w =
/// log(d(0) / d), with w' = g. g is smooth and never negative. A long step is therefore inaccurate, but never unstable.
class Decay {
public:
    Decay(double difference, double ambient, const CoolingRates& rates)
        : difference_(difference), ambient_(ambient), rates_(rates) {}

    /// Returns w at a time.
    [[nodiscard]] double after(double duration) const {
        double w = 0.0;
        double done = 0.0;
        double h = duration;
        while (done < duration && w < kUnderflowExponent) {
            h = std::min(h, duration - done);
            const double once = step(w, h);
            const double twice = step(step(w, 0.5 * h), 0.5 * h);
            const double error = std::fabs(twice - once) / 15.0;  // Richardson's estimate for a method of fourth order
            const double most = kCoolingError * (1.0 + twice);
            if (error <= most) {
                w = twice + (twice - once) / 15.0;
                done += h;
                if (error < most / 64.0) h *= 2.0;
            } else {
                h *= 0.5;
            }
        }
        return w;
    }
    [[nodiscard]] double rate(double w) const {
        const double t = ambient_ + difference_ * portable_exp(-w);
        return rates_.convection + rates_.radiation * ((t * t + ambient_ * ambient_) * (t + ambient_));
    }

private:
    /// Returns w after a step of length h with the classical Runge-Kutta method.
    [[nodiscard]] double step(double w, double h) const {
        const double k1 = rate(w);
        const double k2 = rate(w + 0.5 * h * k1);
        const double k3 = rate(w + 0.5 * h * k2);
        const double k4 = rate(w + h * k3);
        return w + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }

    double difference_;  // in K, at the start
    double ambient_;     // in K
    CoolingRates rates_;
};

/// Returns the ambient temperature plus the remaining difference. The result is clamped to the range from `start` to
/// `ambient`, because rounding could exceed it.
double between(double start, double ambient, double left) {
    return std::clamp(ambient + left, std::min(start, ambient), std::max(start, ambient));
}

}  // namespace

double heat_transfer_coefficient(const Convection& convection, double radius, double speed) {
    if (convection.coefficient) return *convection.coefficient;
    const double diameter = 2.0 * radius;
    const double reynolds = convection.density * speed * diameter / convection.viscosity;
    const double nusselt = 2.0 + 0.6 * std::sqrt(reynolds) * portable_pow(convection.prandtl, 1.0 / 3.0);
    return nusselt * convection.conductivity / diameter;
}

CoolingRates cooling_rates(const HeatSettings& heat, double mass, double radius, double coefficient) {
    const double area = 4.0 * std::numbers::pi * radius * radius;
    const double per_watt = area / (mass * heat.specific_heat);
    return {coefficient * per_watt, heat.emissivity * kStefanBoltzmann * per_watt};
}

double cooled(double temperature, double ambient, const CoolingRates& rates, double duration) {
    double difference = temperature - ambient;
    if (!std::isfinite(temperature) || difference == 0.0 || !(duration > 0.0)) return temperature;
    if (rates.radiation == 0.0) {
        return between(temperature, ambient, difference * portable_exp(-rates.convection * duration));
    }
    const double lasting = portable_pow(3.0 * rates.radiation * duration, -1.0 / 3.0);  // in K
    difference = std::min(difference, kStartDifferenceLimit * lasting);
    if (ambient == 0.0 && rates.convection == 0.0) {
        const double ratio = difference / lasting;
        return difference * portable_pow(1.0 + ratio * ratio * ratio, -1.0 / 3.0);
    }
    const Decay decay(difference, ambient, rates);
    const double slowest = std::min(decay.rate(0.0), decay.rate(kUnderflowExponent));
    // In these cases the remaining difference is 0. The rates of very light bodies could overflow in the integration.
    if (!std::isfinite(decay.rate(0.0)) || slowest * duration >= kUnderflowExponent) return ambient;
    return between(temperature, ambient, difference * portable_exp(-decay.after(duration)));
}

}  // namespace ricochet
