#include "ricochet/dynamics/anchor.h"

#include <algorithm>
#include <utility>

#include "ricochet/dynamics/detail/checks.h"

namespace ricochet {
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

}  // namespace ricochet
