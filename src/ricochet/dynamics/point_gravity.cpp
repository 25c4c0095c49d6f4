#include "ricochet/dynamics/point_gravity.h"

#include <cmath>
#include <utility>

#include "ricochet/dynamics/detail/checks.h"

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

}  // namespace ricochet
