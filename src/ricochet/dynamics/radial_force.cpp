#include "ricochet/dynamics/radial_force.h"

#include <fmt/format.h>

#include <cmath>

#include "ricochet/core/error.h"
#include "ricochet/core/portable_math.h"
#include "ricochet/dynamics/detail/checks.h"

namespace ricochet {
namespace {

// x^exponent for x > 0: whole exponents, the usual ones, by multiplication.
double power(double x, double exponent) {
    if (exponent != std::floor(exponent)) return portable_pow(x, exponent);
    const double base = exponent < 0.0 ? 1.0 / x : x;
    double result = 1.0;
    for (int i = static_cast<int>(std::fabs(exponent)); i > 0; --i) result *= base;
    return result;
}

class RadialForce final : public Force {
public:
    explicit RadialForce(const RadialForceSettings& settings) : settings_(settings) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override {
        const Vec3 d = (input.position - settings_.center) / settings_.reference;
        const double s = distance(d);
        if (s == 0.0) return {};
        return d * (-settings_.strength * power(s, settings_.exponent - 1.0) / input.mass);
    }
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const override {
        const double s = distance((input.position - settings_.center) / settings_.reference);
        const double next = settings_.exponent + 1.0;
        const double scale = settings_.strength * settings_.reference;
        if (next == 0.0) return scale * portable_log(s);
        if (s == 0.0 && next > 0.0) return 0.0;
        return scale * power(s, next) / next;
    }
    [[nodiscard]] bool is_steady() const override { return true; }

private:
    // Softened, in units of the reference.
    [[nodiscard]] double distance(const Vec3& d) const {
        const double softening = settings_.softening / settings_.reference;
        return std::sqrt(length_squared(d) + softening * softening);
    }

    RadialForceSettings settings_;
};

}  // namespace

std::unique_ptr<Force> make_radial_force(const RadialForceSettings& settings) {
    detail::require_finite(settings.center, "radial force: the centre", "m");
    detail::require_finite(settings.strength, "radial force: the strength", "N");
    detail::require_finite(settings.exponent, "radial force: the exponent", "");
    detail::require_not_negative(settings.softening, "radial force: the softening length", "m");
    detail::require_positive(settings.reference, "radial force: the reference distance", "m");
    if (std::fabs(settings.exponent) > kLargestRadialExponent) {
        throw InputError(fmt::format("radial force: the exponent must be {} to {}, found {}", -kLargestRadialExponent,
                                     kLargestRadialExponent, settings.exponent));
    }
    return std::make_unique<RadialForce>(settings);
}

}  // namespace ricochet
