#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/portable_math.h"
#include "ricochet/dynamics/checks.h"
#include "ricochet/dynamics/forces.h"

namespace ricochet {

namespace {

class PointGravity final : public Force {
public:
    explicit PointGravity(std::vector<Attractor> attractors) : attractors_(std::move(attractors)) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override {
        Vec3 sum;
        for (const Attractor& attractor : attractors_) {
            const Vec3 d = input.position - attractor.position;
            const double square = length_squared(d) + attractor.softening * attractor.softening;
            if (square == 0.0) continue;
            sum += d * (-attractor.strength / (square * std::sqrt(square)));
        }
        return sum;
    }
    // Zero infinitely far away.
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const override {
        double sum = 0.0;
        for (const Attractor& attractor : attractors_) {
            const Vec3 d = input.position - attractor.position;
            sum -= attractor.strength / std::sqrt(length_squared(d) + attractor.softening * attractor.softening);
        }
        return input.mass * sum;
    }
    [[nodiscard]] bool is_steady() const override { return true; }

private:
    std::vector<Attractor> attractors_;
};

}  // namespace

std::unique_ptr<Force> make_point_gravity(std::vector<Attractor> attractors) {
    for (const Attractor& attractor : attractors) {
        detail::require_finite(attractor.position, "point gravity: the position", "m");
        detail::require_finite(attractor.strength, "point gravity: the strength", "m^3/s^2");
        detail::require_not_negative(attractor.softening, "point gravity: the softening length", "m");
    }
    return std::make_unique<PointGravity>(std::move(attractors));
}

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

namespace {

class Anchor final : public Force {
public:
    explicit Anchor(AnchorSettings settings) : settings_(std::move(settings)) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override {
        if (!holds(input.id)) return {};
        const Vec3 d = input.position - settings_.position;
        const double distance = length(d);
        if (distance == 0.0) return {};
        const Vec3 along = d / distance;
        const double pull =
            settings_.stiffness * (distance - settings_.rest_length) + settings_.damping * dot(input.velocity, along);
        return along * (-pull / input.mass);
    }
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const override {
        if (!holds(input.id)) return 0.0;
        const double stretch = length(input.position - settings_.position) - settings_.rest_length;
        return 0.5 * settings_.stiffness * stretch * stretch;
    }
    [[nodiscard]] bool is_steady() const override { return true; }

private:
    [[nodiscard]] bool holds(std::uint64_t id) const {
        const auto& ids = settings_.particles;
        return ids.empty() || std::binary_search(ids.begin(), ids.end(), id);
    }

    AnchorSettings settings_;  // particles in order
};

}  // namespace

std::unique_ptr<Force> make_anchor(AnchorSettings settings) {
    detail::require_finite(settings.position, "anchor: the position", "m");
    detail::require_not_negative(settings.stiffness, "anchor: the stiffness", "N/m");
    detail::require_not_negative(settings.rest_length, "anchor: the rest length", "m");
    detail::require_not_negative(settings.damping, "anchor: the damping", "kg/s");
    std::sort(settings.particles.begin(), settings.particles.end());
    return std::make_unique<Anchor>(std::move(settings));
}

namespace {

class LorentzForce final : public Force {
public:
    explicit LorentzForce(const LorentzSettings& settings) : settings_(settings) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override {
        const double specific = charge_of(input) / input.mass;
        return (settings_.electric + cross(input.velocity, settings_.magnetic)) * specific;
    }
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const override {
        return -charge_of(input) * dot(settings_.electric, input.position);
    }
    [[nodiscard]] bool is_uniform() const override { return settings_.charge == 0.0 || settings_.magnetic == Vec3{}; }
    [[nodiscard]] bool is_steady() const override { return true; }

private:
    // The one place that knows whose charge it is.
    [[nodiscard]] double charge_of(const ForceInput&) const { return settings_.charge; }

    LorentzSettings settings_;
};

}  // namespace

std::unique_ptr<Force> make_lorentz_force(const LorentzSettings& settings) {
    detail::require_finite(settings.charge, "Lorentz force: the charge", "C");
    detail::require_finite(settings.electric, "Lorentz force: the electric field", "V/m");
    detail::require_finite(settings.magnetic, "Lorentz force: the magnetic field", "T");
    return std::make_unique<LorentzForce>(settings);
}

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

namespace {

class FieldForce final : public Force {
public:
    FieldForce(FlowPointer field, FieldMeaning meaning) : field_(std::move(field)), meaning_(meaning) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override {
        const Vec3 value = field_->velocity(input.position, input.time);
        return meaning_ == FieldMeaning::force ? value / input.mass : value;
    }
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput&) const override { return std::nullopt; }
    [[nodiscard]] bool is_uniform() const override { return field_->is_uniform() && field_->is_steady(); }
    [[nodiscard]] bool is_steady() const override { return field_->is_steady(); }

private:
    FlowPointer field_;
    FieldMeaning meaning_;
};

}  // namespace

std::unique_ptr<Force> make_field_force(FlowPointer field, FieldMeaning meaning) {
    if (!field) throw InputError("field force: found a null pointer, expected a field");
    return std::make_unique<FieldForce>(std::move(field), meaning);
}

std::unique_ptr<Force> make_swirl(const Vec3& point, const Vec3& axis, double acceleration, double core_radius) {
    detail::require_finite(point, "swirl: the point on the axis", "m");
    detail::require_finite(acceleration, "swirl: the acceleration", "m/s^2");
    detail::require_positive(core_radius, "swirl: the core radius", "m");
    // A Rankine vortex whose speed at the rim of its core is that number.
    const double circulation = 2.0 * std::numbers::pi * core_radius * acceleration;
    return make_field_force(
        make_vortex({point, detail::unit_direction(axis, "swirl: the axis"), circulation, core_radius}),
        FieldMeaning::acceleration);
}

}  // namespace ricochet
