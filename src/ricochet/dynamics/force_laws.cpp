#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "ricochet/core/checks.h"
#include "ricochet/core/error.h"
#include "ricochet/core/portable_math.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/stability.h"

namespace ricochet {

namespace {

using detail::require_finite;
using detail::require_not_negative;
using detail::require_positive;

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
    // The potential is zero at infinity.
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const override {
        double sum = 0.0;
        for (const Attractor& attractor : attractors_) {
            const Vec3 d = input.position - attractor.position;
            sum -= attractor.strength / std::sqrt(length_squared(d) + attractor.softening * attractor.softening);
        }
        return input.mass * sum;
    }
    [[nodiscard]] bool is_steady() const override { return true; }
    [[nodiscard]] bool is_conservative() const override { return true; }
    [[nodiscard]] bool is_singular() const {
        return std::any_of(attractors_.begin(), attractors_.end(),
                           [](const Attractor& a) { return a.strength > 0.0 && a.softening == 0.0; });
    }

private:
    std::vector<Attractor> attractors_;
};

// Returns x^exponent for x > 0. Integer exponents are the common case and use multiplication.
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
    [[nodiscard]] bool is_conservative() const override { return true; }
    [[nodiscard]] bool is_singular() const {
        return settings_.strength > 0.0 && settings_.softening == 0.0 && settings_.exponent < 0.0;
    }

private:
    // Returns the softened distance, in units of the reference.
    [[nodiscard]] double distance(const Vec3& d) const {
        const double softening = settings_.softening / settings_.reference;
        return std::sqrt(length_squared(d) + softening * softening);
    }

    RadialForceSettings settings_;
};

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
    [[nodiscard]] bool is_conservative() const override { return settings_.damping == 0.0; }

private:
    [[nodiscard]] bool holds(std::uint64_t id) const {
        const auto& ids = settings_.particles;
        return ids.empty() || std::binary_search(ids.begin(), ids.end(), id);
    }

    AnchorSettings settings_;  // particles are sorted
};

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
    [[nodiscard]] bool is_conservative() const override { return true; }

private:
    // The only function that knows the charge of a particle.
    [[nodiscard]] double charge_of(const ForceInput&) const { return settings_.charge; }

    LorentzSettings settings_;
};

class Buoyancy final : public Force {
public:
    Buoyancy(double fluid_density, const Vec3& gravity) : fluid_density_(fluid_density), gravity_(gravity) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override {
        return gravity_ * (-displaced_mass(input) / input.mass);
    }
    // The potential is zero at the world's origin.
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const override {
        return displaced_mass(input) * dot(gravity_, input.position);
    }
    [[nodiscard]] bool is_uniform() const override { return true; }
    [[nodiscard]] bool is_conservative() const override { return true; }

private:
    [[nodiscard]] double displaced_mass(const ForceInput& input) const {
        return fluid_density_ * (4.0 / 3.0 * std::numbers::pi) * (input.radius * input.radius * input.radius);
    }

    double fluid_density_;
    Vec3 gravity_;
};

class ThermalBuoyancy final : public Force {
public:
    ThermalBuoyancy(double ambient, const Vec3& gravity) : ambient_(ambient), gravity_(gravity) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override {
        return gravity_ * (-input.temperature / ambient_);
    }
    // The lift at a position changes with the particle's temperature, so the force has no potential.
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& /*input*/) const override {
        return std::nullopt;
    }
    [[nodiscard]] bool needs_temperature() const override { return true; }

private:
    double ambient_;
    Vec3 gravity_;
};

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

/// Physical constants of the drag of spheres.
constexpr double kNewtonReynolds = 1000.0;  // Reynolds number from which the coefficient is constant
constexpr double kNewtonCoefficient = 0.44;

// Returns 0.15 Re^0.687, the relative excess of drag over Stokes's law.
double schiller_naumann_excess(double reynolds) { return 0.15 * portable_pow(reynolds, 0.687); }

class AnyDrag : public Force {};

// Drag by a law that provides factor(speed, input) in kg/s: the drag force divided by the velocity relative to the
// medium. The speed is computed only if the law sets kNeedsSpeed. The template avoids a virtual call of the law.
template <class Law>
class Drag final : public AnyDrag {
public:
    Drag(const Law& law, FlowPointer flow) : law_(law), flow_(std::move(flow)) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override {
        const Vec3 w = flow_ ? input.velocity - flow_->velocity(input.position, input.time) : input.velocity;
        double speed = 0.0;
        if constexpr (Law::kNeedsSpeed) speed = length(w);
        return w * (-law_.factor(speed, input) / input.mass);
    }
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput&) const override { return 0.0; }
    [[nodiscard]] bool is_steady() const override { return !flow_ || flow_->is_steady(); }

private:
    Law law_;
    FlowPointer flow_;
};

struct LinearLaw {
    static constexpr bool kNeedsSpeed = false;
    double coefficient;
    [[nodiscard]] double factor(double, const ForceInput&) const { return coefficient; }
};

struct QuadraticLaw {
    static constexpr bool kNeedsSpeed = true;
    double coefficient;
    [[nodiscard]] double factor(double speed, const ForceInput&) const { return coefficient * speed; }
};

struct SphereLaw {
    static constexpr bool kNeedsSpeed = true;
    double per_area;  // half the density times the drag coefficient times pi
    [[nodiscard]] double factor(double speed, const ForceInput& input) const {
        return per_area * (input.radius * input.radius) * speed;
    }
};

struct StokesLaw {
    static constexpr bool kNeedsSpeed = false;
    double per_radius;  // 6 pi viscosity
    [[nodiscard]] double factor(double, const ForceInput& input) const { return per_radius * input.radius; }
};

struct SchillerNaumannLaw {
    static constexpr bool kNeedsSpeed = true;
    double density;
    double viscosity;
    [[nodiscard]] double factor(double speed, const ForceInput& input) const {
        const double reynolds = density * speed * (2.0 * input.radius) / viscosity;
        if (reynolds >= kNewtonReynolds) {
            return 0.5 * std::numbers::pi * kNewtonCoefficient * density * (input.radius * input.radius) * speed;
        }
        const double stokes = 6.0 * std::numbers::pi * viscosity * input.radius;
        return reynolds > 0.0 ? stokes * (1.0 + schiller_naumann_excess(reynolds)) : stokes;
    }
};

template <class Law>
std::unique_ptr<Force> drag_of(const Law& law, FlowPointer flow) {
    return std::make_unique<Drag<Law>>(law, std::move(flow));
}

}  // namespace

std::unique_ptr<Force> make_point_gravity(std::vector<Attractor> attractors) {
    for (const Attractor& attractor : attractors) {
        require_finite(attractor.position, "point gravity: the position", "m");
        require_finite(attractor.strength, "point gravity: the strength", "m^3/s^2");
        require_not_negative(attractor.softening, "point gravity: the softening length", "m");
    }
    return std::make_unique<PointGravity>(std::move(attractors));
}

std::unique_ptr<Force> make_radial_force(const RadialForceSettings& settings) {
    require_finite(settings.center, "radial force: the centre", "m");
    require_finite(settings.strength, "radial force: the strength", "N");
    require_finite(settings.exponent, "radial force: the exponent", "");
    require_not_negative(settings.softening, "radial force: the softening length", "m");
    require_positive(settings.reference, "radial force: the reference distance", "m");
    if (std::fabs(settings.exponent) > kLargestRadialExponent) {
        throw InputError(fmt::format("radial force: the exponent must be {} to {}, found {}", -kLargestRadialExponent,
                                     kLargestRadialExponent, settings.exponent));
    }
    return std::make_unique<RadialForce>(settings);
}

std::unique_ptr<Force> make_anchor(AnchorSettings settings) {
    require_finite(settings.position, "anchor: the position", "m");
    require_not_negative(settings.stiffness, "anchor: the stiffness", "N/m");
    require_not_negative(settings.rest_length, "anchor: the rest length", "m");
    require_not_negative(settings.damping, "anchor: the damping", "kg/s");
    std::sort(settings.particles.begin(), settings.particles.end());
    return std::make_unique<Anchor>(std::move(settings));
}

std::unique_ptr<Force> make_lorentz_force(const LorentzSettings& settings) {
    require_finite(settings.charge, "Lorentz force: the charge", "C");
    require_finite(settings.electric, "Lorentz force: the electric field", "V/m");
    require_finite(settings.magnetic, "Lorentz force: the magnetic field", "T");
    return std::make_unique<LorentzForce>(settings);
}

std::unique_ptr<Force> make_thermal_buoyancy(double ambient_temperature, const Vec3& gravity) {
    require_positive(ambient_temperature, "thermal buoyancy: the ambient temperature", "K");
    require_finite(gravity, "thermal buoyancy: the gravity", "m/s^2");
    return std::make_unique<ThermalBuoyancy>(ambient_temperature, gravity);
}

std::unique_ptr<Force> make_buoyancy(double fluid_density, const Vec3& gravity) {
    require_not_negative(fluid_density, "buoyancy: the fluid's density", "kg/m^3");
    require_finite(gravity, "buoyancy: the gravity", "m/s^2");
    return std::make_unique<Buoyancy>(fluid_density, gravity);
}

std::unique_ptr<Force> make_field_force(FlowPointer field, FieldMeaning meaning) {
    if (!field) throw InputError("field force: found a null pointer, expected a field");
    if (meaning != FieldMeaning::acceleration && meaning != FieldMeaning::force) {
        throw InputError("field force: expected accelerations or forces as the field's meaning");
    }
    return std::make_unique<FieldForce>(std::move(field), meaning);
}

std::unique_ptr<Force> make_swirl(const Vec3& point, const Vec3& axis, double acceleration, double core_radius) {
    require_finite(point, "swirl: the point on the axis", "m");
    require_finite(acceleration, "swirl: the acceleration", "m/s^2");
    require_positive(core_radius, "swirl: the core radius", "m");
    // The field is a Rankine vortex whose speed at the edge of its core equals the acceleration.
    const double circulation = 2.0 * std::numbers::pi * core_radius * acceleration;
    return make_field_force(
        make_vortex({point, detail::unit_direction(axis, "swirl: the axis"), circulation, core_radius}),
        FieldMeaning::acceleration);
}

bool is_drag_law(const Force& force) { return dynamic_cast<const AnyDrag*>(&force) != nullptr; }

std::optional<EnergyLaw> energy_law_of_global_force(const Force& force) {
    EnergyLaw law;
    if (dynamic_cast<const Buoyancy*>(&force) != nullptr) return law;
    law.is_dissipative = is_drag_law(force);
    if (law.is_dissipative) return law;
    law.varies = true;
    if (const auto* const gravity = dynamic_cast<const PointGravity*>(&force)) {
        law.is_singular = gravity->is_singular();
    } else if (const auto* const radial = dynamic_cast<const RadialForce*>(&force)) {
        law.is_singular = radial->is_singular();
    } else if (dynamic_cast<const Anchor*>(&force) != nullptr) {
        law.is_dissipative = !force.is_conservative();
    } else if (dynamic_cast<const LorentzForce*>(&force) != nullptr) {
        law.is_magnetic = law.varies = !force.is_uniform();
    } else {
        return std::nullopt;
    }
    return law;
}

std::unique_ptr<Force> make_linear_drag(double coefficient, FlowPointer flow) {
    require_not_negative(coefficient, "drag: the coefficient", "kg/s");
    return drag_of(LinearLaw{coefficient}, std::move(flow));
}

std::unique_ptr<Force> make_quadratic_drag(double coefficient, FlowPointer flow) {
    require_not_negative(coefficient, "quadratic drag: the coefficient", "kg/m");
    return drag_of(QuadraticLaw{coefficient}, std::move(flow));
}

std::unique_ptr<Force> make_sphere_drag(double drag_coefficient, double fluid_density, FlowPointer flow) {
    require_not_negative(drag_coefficient, "sphere drag: the drag coefficient", "");
    require_not_negative(fluid_density, "sphere drag: the fluid's density", "kg/m^3");
    return drag_of(SphereLaw{0.5 * fluid_density * drag_coefficient * std::numbers::pi}, std::move(flow));
}

std::unique_ptr<Force> make_stokes_drag(double viscosity, FlowPointer flow) {
    require_not_negative(viscosity, "Stokes drag: the viscosity", "Pa s");
    return drag_of(StokesLaw{6.0 * std::numbers::pi * viscosity}, std::move(flow));
}

std::unique_ptr<Force> make_schiller_naumann_drag(double fluid_density, double viscosity, FlowPointer flow) {
    require_not_negative(fluid_density, "Schiller-Naumann drag: the fluid's density", "kg/m^3");
    require_positive(viscosity, "Schiller-Naumann drag: the viscosity", "Pa s");
    return drag_of(SchillerNaumannLaw{fluid_density, viscosity}, std::move(flow));
}

double schiller_naumann_coefficient(double reynolds) {
    require_positive(reynolds, "drag coefficient: the Reynolds number", "");
    if (reynolds >= kNewtonReynolds) return kNewtonCoefficient;
    return 24.0 / reynolds * (1.0 + schiller_naumann_excess(reynolds));
}

}  // namespace ricochet
