#include "ricochet/dynamics/electromagnetic.h"

#include "ricochet/dynamics/detail/checks.h"

namespace ricochet {
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

}  // namespace ricochet
