#include "ricochet/dynamics/buoyancy.h"

#include <numbers>

#include "ricochet/dynamics/detail/checks.h"

namespace ricochet {
namespace {

class Buoyancy final : public Force {
public:
    Buoyancy(double fluid_density, const Vec3& gravity) : fluid_density_(fluid_density), gravity_(gravity) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override {
        return gravity_ * (-displaced_mass(input) / input.mass);
    }
    // Zero at the world's origin.
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const override {
        return displaced_mass(input) * dot(gravity_, input.position);
    }
    [[nodiscard]] bool is_uniform() const override { return true; }

private:
    [[nodiscard]] double displaced_mass(const ForceInput& input) const {
        return fluid_density_ * (4.0 / 3.0 * std::numbers::pi) * (input.radius * input.radius * input.radius);
    }

    double fluid_density_;
    Vec3 gravity_;
};

}  // namespace

std::unique_ptr<Force> make_buoyancy(double fluid_density, const Vec3& gravity) {
    detail::require_not_negative(fluid_density, "buoyancy: the fluid's density", "kg/m^3");
    detail::require_finite(gravity, "buoyancy: the gravity", "m/s^2");
    return std::make_unique<Buoyancy>(fluid_density, gravity);
}

}  // namespace ricochet
