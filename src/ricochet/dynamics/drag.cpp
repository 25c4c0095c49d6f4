#include "ricochet/dynamics/forces.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "ricochet/core/portable_math.h"
#include "ricochet/dynamics/checks.h"

namespace ricochet {
namespace {

using detail::require_not_negative;
using detail::require_positive;

constexpr double kNewtonReynolds = 1000.0;  // from here on the coefficient is constant
constexpr double kNewtonCoefficient = 0.44;

// The 0.15 Re^0.687 by which drag exceeds Stokes's.
double schiller_naumann_excess(double reynolds) { return 0.15 * portable_pow(reynolds, 0.687); }

// Law: factor(speed, input) in kg/s, the force over the velocity relative to the medium; with kNeedsSpeed it is told
// the speed. A template, so that a law costs no call of its own.
template <class Law>
class Drag final : public Force {
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
    double per_area;  // half the density times the coefficient, times pi
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
