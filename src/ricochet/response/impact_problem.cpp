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
        find_restitutions();
    }

    /// Solves the impact. Contacts that slip although they could stick get the friction of slip, in another solution.
    ImpactResult solve() {
        ImpactResult result = solve_once();
        for (std::size_t pass = 0; pass < count_ && lets_slip(result); ++pass) result = solve_once();
        return slowed(result);
    }

private:
    [[nodiscard]] ImpactResult solve_once() {
        const bool has_friction =
            std::ranges::any_of(surfaces_, [](const ImpactSurface& surface) { return surface.friction > 0.0; });
        if (!has_friction || (restitution_ == 0.0 && !reverses_slip_)) return kept(whole(restitution_));
        if (const std::optional<ImpactResult> result = find(restitution_)) {
            if (!gains(*result)) return kept(*result);
        }
        return kept(repeated(whole(0.0)));
    }

    /// Marks the contacts whose static friction did not suffice. Returns true if there are new ones.
    [[nodiscard]] bool lets_slip(const ImpactResult& result) {
        bool is_new = false;
        for (std::size_t c = 0; c < count_; ++c) {
            const ImpactSurface& surface = surfaces_[surface_of_[c]];
            if (slips_[c] || !(surface.static_friction > surface.friction)) continue;
            const Vec3& change = result.velocity_change[surface_of_[c]];
            const double pressing = dot(change, surface.normal);
            const double along = length(change - pressing * surface.normal);
            // Friction at its limit has not stopped the slip. Either answer is right within rounding of the limit.
            slips_[c] = along >= (1.0 - kCoulombResidual) * surface.static_friction * pressing && pressing > 0.0;
            is_new = is_new || slips_[c];
        }
        return is_new;
    }

    [[nodiscard]] double friction_of(std::size_t c) const {
        const ImpactSurface& surface = surfaces_[surface_of_[c]];
        return slips_[c] ? surface.friction : std::max(surface.friction, surface.static_friction);
    }

    /// Adds a surface. A surface with the same normal is replaced if its approach is clearly slower.
    void add(std::size_t surface) {
        const ImpactSurface& added = surfaces_[surface];
        tangential_factor_ = std::min(tangential_factor_, added.tangential_factor);
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

    /// Finds the restitutions. Slip is reversed only at a single hit surface, beside others that support the particle.
    /// Among several, the friction of one surface could act along the slip on it.
    void find_restitutions() {
        const auto is_hit = [&](const ImpactSurface& surface) {
            return !surface.is_support && separation_speed(surface) < 0.0;
        };
        for (const ImpactSurface& surface : surfaces_) {
            if (is_hit(surface)) restitution_ = std::min(restitution_, surface.restitution);
        }
        std::size_t hit = 0;
        for (std::size_t c = 0; c < count_; ++c) {
            const ImpactSurface& surface = surfaces_[surface_of_[c]];
            if (!is_hit(surface)) continue;
            ++hit;
            reverses_slip_ = surface.tangential_restitution > 0.0;
        }
        reverses_slip_ = reverses_slip_ && hit == 1;
    }

    /// Returns the speed, in m/s, at which the particle separates along the normal before the impact.
    [[nodiscard]] double separation_speed(const ImpactSurface& surface) const {
        return dot(before_.velocity, surface.normal) - surface.advance;
    }

    enum class Slip { stops, reverses };

    /// Sets up the equations. slip_end: effect of sufficient friction on the slip.
    void set_up(double restitution, Slip slip_end = Slip::stops) {
        problem_.clear();
        for (std::size_t c = 0; c < count_; ++c) {
            const ImpactSurface& surface = surfaces_[surface_of_[c]];
            const double rebound = surface.is_support ? 0.0 : restitution;
            problem_.add({normal_direction(surface.normal), (1.0 + rebound) * separation_speed(surface)});
        }
        for (std::size_t c = 0; c < count_; ++c) {
            const ImpactSurface& surface = surfaces_[surface_of_[c]];
            if (surface.friction == 0.0) continue;
            Vec3 slip = slip_velocity(before_, radius_, surface.normal) - surface.velocity;
            const bool is_hit = !surface.is_support && separation_speed(surface) < 0.0;
            if (slip_end == Slip::reverses && reverses_slip_ && is_hit) slip *= 1.0 + surface.tangential_restitution;
            problem_.add(
                sliding_friction(static_cast<std::uint32_t>(c), surface.normal, friction_of(c), radius_ > 0.0, slip));
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
        set_up(restitution, Slip::reverses);
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

    /// Scales the velocity that is tangential to all surfaces, relative to the first surface.
    [[nodiscard]] ImpactResult slowed(ImpactResult result) const {
        if (tangential_factor_ == 1.0 || count_ == 0) return result;
        std::array<Vec3, ImpactResult::kMostSurfaces> normals;
        for (std::size_t c = 0; c < count_; ++c) normals[c] = surfaces_[surface_of_[c]].normal;
        const Vec3 along = along_all(result.after.velocity - surfaces_[surface_of_[0]].velocity,
                                     std::span<const Vec3>(normals).first(count_));
        result.slowing = (tangential_factor_ - 1.0) * along;
        result.slowed_by = surface_of_[0];
        result.after.velocity += result.slowing;
        return result;
    }

    const Motion& before_;
    double radius_;
    std::span<const ImpactSurface> surfaces_;
    double restitution_ = 1.0;
    double tangential_factor_ = 1.0;
    bool reverses_slip_ = false;
    bool is_driven_ = false;  // true if a surface moves
    std::size_t count_ = 0;   // number of different normals
    std::array<std::size_t, ImpactResult::kMostSurfaces> surface_of_{};
    std::array<bool, ImpactResult::kMostSurfaces> slips_{};  // static friction does not suffice
    CoulombProblem problem_;
};

}  // namespace

ImpactResult solve_impact(const Motion& before, double radius, std::span<const ImpactSurface> surfaces) {
    return Impact(before, radius, surfaces).solve();
}

}  // namespace ricochet
