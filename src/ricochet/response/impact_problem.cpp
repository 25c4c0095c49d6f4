#include "ricochet/response/impact_problem.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/sphere_contact.h"

namespace ricochet {
namespace {

class Impact {
public:
    Impact(const Motion& before, double radius, std::span<const ImpactSurface> surfaces)
        : before_(before), radius_(radius), surfaces_(surfaces) {
        for (std::size_t k = 0; k < surfaces_.size(); ++k) add(k);
    }

    ImpactResult solve() {
        const bool has_friction =
            std::ranges::any_of(surfaces_, [](const ImpactSurface& surface) { return surface.friction > 0.0; });
        if (!has_friction || restitution_ == 0.0) return kept(whole(restitution_));
        if (const std::optional<ImpactResult> result = find(restitution_)) {
            if (!gains(*result)) return kept(*result);
        }
        return kept(repeated(whole(0.0)));
    }

private:
    /// Adds a surface. A surface with the same normal is replaced if its approach is clearly slower.
    void add(std::size_t surface) {
        const ImpactSurface& added = surfaces_[surface];
        if (!added.is_support && separation_speed(added) < 0.0)
            restitution_ = std::min(restitution_, added.restitution);
        is_driven_ = is_driven_ || added.velocity != Vec3{} || added.angular_velocity != Vec3{};
        for (std::size_t c = 0; c < count_; ++c) {
            const ImpactSurface& known = surfaces_[surface_of_[c]];
            if (length(known.normal - added.normal) > kSameDirection) continue;
            const double rounding = kSameDirection * (length(before_.velocity) + length(added.velocity));
            if (separation_speed(added) < separation_speed(known) - rounding) surface_of_[c] = surface;
            return;
        }
        surface_of_[count_++] = surface;
    }

    /// Returns the speed, in m/s, at which the particle separates along the normal before the impact.
    [[nodiscard]] double separation_speed(const ImpactSurface& surface) const {
        return dot(before_.velocity, surface.normal) - surface.advance;
    }

    void set_up(double restitution) {
        problem_.clear();
        for (std::size_t c = 0; c < count_; ++c) {
            const ImpactSurface& surface = surfaces_[surface_of_[c]];
            const double rebound = surface.is_support ? 0.0 : restitution;
            problem_.add({normal_direction(surface.normal), (1.0 + rebound) * separation_speed(surface)});
        }
        for (std::size_t c = 0; c < count_; ++c) {
            const ImpactSurface& surface = surfaces_[surface_of_[c]];
            if (surface.friction == 0.0) continue;
            const Vec3 slip = slip_velocity(before_, radius_, surface.normal) - surface.velocity;
            problem_.add(
                sliding_friction(static_cast<std::uint32_t>(c), surface.normal, surface.friction, radius_ > 0.0, slip));
        }
        if (radius_ > 0.0) resist_turning();
    }

    void resist_turning() {
        for (std::size_t c = 0; c < count_; ++c) {
            const ImpactSurface& surface = surfaces_[surface_of_[c]];
            const auto contact = static_cast<std::uint32_t>(c);
            const Vec3 turning = radius_ * (before_.spin - surface.angular_velocity);
            if (surface.rolling_friction > 0.0) {
                problem_.add(rolling_resistance(contact, surface.normal, surface.rolling_friction, turning));
            }
            if (surface.spinning_friction > 0.0) {
                const double bound = surface.spinning_friction / radius_;
                problem_.add(spinning_resistance(contact, surface.normal, bound, turning));
            }
        }
    }

    /// Returns the solution with the largest friction for which one exists.
    ImpactResult whole(double restitution) {
        set_up(restitution);
        problem_.solve_with_most(CoulombProblem::Effort::all);
        return solution();
    }

    /// Returns the impact with 1 + e times the impulses of `result`, which has no rebound.
    [[nodiscard]] ImpactResult repeated(ImpactResult result) const {
        result.after.velocity += restitution_ * (result.after.velocity - before_.velocity);
        result.after.spin += restitution_ * (result.after.spin - before_.spin);
        for (Vec3& velocity_change : result.velocity_change) velocity_change *= 1.0 + restitution_;
        keep_supported_only(result);
        return result;
    }

    /// Removes the approach to supporting surfaces, which the factor 1 + e on the impulses can make of a rounding
    /// error.
    void keep_supported_only(ImpactResult& result) const {
        ShortestShift shift;
        std::size_t last = 0;
        for (std::size_t c = 0; c < count_; ++c) {
            const ImpactSurface& surface = surfaces_[surface_of_[c]];
            const double approach = surface.advance - dot(result.after.velocity, surface.normal);
            if (!surface.is_support || !(approach > 0.0)) continue;
            shift.add(surface.normal, approach);
            last = surface_of_[c];
        }
        if (shift.is_empty()) return;
        result.after.velocity += shift.vector();
        result.velocity_change[last] += shift.vector();
    }

    /// Returns the solution with full friction, if it is found quickly.
    [[nodiscard]] std::optional<ImpactResult> find(double restitution) {
        set_up(restitution);
        if (!problem_.solve(CoulombProblem::Effort::some)) return std::nullopt;
        return solution();
    }

    [[nodiscard]] ImpactResult solution() const {
        ImpactResult result;
        std::size_t resistance = 0;
        for (std::size_t c = 0; c < count_; ++c) {
            const ImpactSurface& surface = surfaces_[surface_of_[c]];
            Vec3& velocity_change = result.velocity_change[surface_of_[c]];
            velocity_change = problem_.reaction(c) * surface.normal;
            if (surface.friction == 0.0) continue;
            velocity_change += along_tangents(problem_.force_of(resistance++), surface.normal);
        }
        const MotionVector change = problem_.change();
        result.after = before_;
        result.after.velocity += velocity_of(change);
        if (radius_ > 0.0) result.after.spin += (kTurning / radius_) * turning_of(change);
        return result;
    }

    /// Returns the rounding error of twice_kinetic(), in m^2/s^2. It is larger if surfaces press against each other.
    [[nodiscard]] double rounding(const ImpactResult& result) const {
        double squared_speeds = twice_kinetic(before_, radius_);
        for (const Vec3& velocity_change : result.velocity_change) squared_speeds += length_squared(velocity_change);
        return kEnergyRounding * squared_speeds;
    }

    [[nodiscard]] bool gains(const ImpactResult& result) const {
        return twice_kinetic(result.after, radius_) > most_allowed(result) + rounding(result);
    }

    /// Returns the largest twice_kinetic() after the impact: that before, plus twice the work of surfaces per unit
    /// mass.
    [[nodiscard]] double most_allowed(const ImpactResult& result) const {
        double sum = twice_kinetic(before_, radius_);
        for (std::size_t k = 0; k < surfaces_.size(); ++k) {
            if (surfaces_[k].velocity != Vec3{}) sum += 2.0 * dot(result.velocity_change[k], surfaces_[k].velocity);
        }
        return sum;
    }

    /// Scales the motion so that rounding adds no energy. An impact without losses keeps the energy exactly.
    [[nodiscard]] ImpactResult kept(ImpactResult result) const {
        if (is_driven_) return result;
        const double is = twice_kinetic(result.after, radius_);
        const double was = twice_kinetic(before_, radius_);
        const bool loses_none =
            restitution_ == 1.0 && was - is <= rounding(result) &&
            std::ranges::all_of(surfaces_, [](const ImpactSurface& surface) { return surface.friction == 0.0; });
        if (is > was || (loses_none && is > 0.0)) {
            const double part = std::sqrt(was / is);
            result.after.velocity *= part;
            result.after.spin *= part;
        }
        return result;
    }

    const Motion& before_;
    double radius_;
    std::span<const ImpactSurface> surfaces_;
    double restitution_ = 1.0;
    bool is_driven_ = false;  // true if a surface moves
    std::size_t count_ = 0;   // number of different normals
    std::array<std::size_t, ImpactResult::kMostSurfaces> surface_of_{};
    CoulombProblem problem_;
};

}  // namespace

ImpactResult solve_impact(const Motion& before, double radius, std::span<const ImpactSurface> surfaces) {
    return Impact(before, radius, surfaces).solve();
}

}  // namespace ricochet
