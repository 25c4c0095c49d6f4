#include "ricochet/response/pair_impact.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

double effective_inverse_mass(const PairBody& a, const PairBody& b) { return a.inverse_mass + b.inverse_mass; }

void apply_impulse(PairBody& a, PairBody& b, const Vec3& normal, const Vec3& impulse) {
    a.velocity -= a.inverse_mass * impulse;
    b.velocity += b.inverse_mass * impulse;
    const Vec3 moment = cross(normal, impulse);
    a.spin -= (a.inverse_inertia * a.radius) * moment;
    b.spin -= (b.inverse_inertia * b.radius) * moment;
}

/// Returns the velocity of the second surface relative to the first at their contact, in m/s.
Vec3 relative_velocity(const PairBody& a, const PairBody& b, const Vec3& normal) {
    return (b.velocity - a.velocity) - cross(a.radius * a.spin + b.radius * b.spin, normal);
}

/// Stops the relative rotation perpendicular to the normal, as far as the rolling moment suffices.
void resist_rolling(const PairMaterial& law, PairBody& a, PairBody& b, const Vec3& normal, double impulse) {
    if (law.rolling_friction == 0.0) return;
    const Vec3 relative = b.spin - a.spin;
    const Vec3 along = relative - dot(relative, normal) * normal;
    const double rate = length(along);
    const double inverse = a.inverse_inertia + b.inverse_inertia;
    if (rate == 0.0 || inverse == 0.0) return;
    const double reduced = a.radius * b.radius / (a.radius + b.radius);
    const double moment = std::min(law.rolling_friction * reduced * impulse, rate / inverse);
    const Vec3 given = (moment / rate) * along;
    a.spin += a.inverse_inertia * given;
    b.spin -= b.inverse_inertia * given;
}

/// Returns the friction impulse on the second body, in N s, along the surface.
Vec3 friction_of(const PairMaterial& law, const PairBody& a, const PairBody& b, const Vec3& normal, double impulse,
                 double share) {
    if (law.friction == 0.0) return {};
    const Vec3 relative = relative_velocity(a, b, normal);
    const Vec3 slip = relative - dot(relative, normal) * normal;
    const double speed = length(slip);
    if (speed == 0.0) return {};
    const double inverse = effective_inverse_mass(a, b) + a.inverse_inertia * a.radius * a.radius +
                           b.inverse_inertia * b.radius * b.radius;
    const double sticking = share * (1.0 + law.tangential_restitution) * speed / inverse;
    return (-std::min(law.friction * impulse, sticking) / speed) * slip;
}

class ImpactProblem {
public:
    ImpactProblem(const PairMaterials& laws, double resting_speed, std::vector<PairBody>& bodies,
                  std::span<PairContact> contacts)
        : laws_(laws), bodies_(bodies), contacts_(contacts), impulses_(contacts.size()), targets_(contacts.size()) {
        for (std::size_t k = 0; k < contacts_.size(); ++k) {
            PairContact& contact = contacts_[k];
            contact.normal = normalized(second(contact).position - first(contact).position);
            contact.approach = -dot(second(contact).velocity - first(contact).velocity, contact.normal);
            targets_[k] = contact.approach > 0.0 ? rebound_speed(law_of(contact), resting_speed, contact.approach)
                                                 : contact.approach;
        }
    }

    void solve() {
        const std::vector<std::size_t> counts = contacts_of_bodies();
        const std::vector<PairBody> before = bodies_;
        if (contacts_.size() == 1) {
            impulses_[0] = std::max(0.0, needed(0));
        } else {
            iterate();
        }
        bodies_ = before;
        // All friction impulses are computed from the same state, so the order of contacts does not matter.
        for (std::size_t k = 0; k < contacts_.size(); ++k) {
            PairContact& contact = contacts_[k];
            const double share = 1.0 / static_cast<double>(std::max(counts[contact.first], counts[contact.second]));
            const PairBody& a = before[contact.first];
            const PairBody& b = before[contact.second];
            contact.impulse =
                impulses_[k] * contact.normal + friction_of(law_of(contact), a, b, contact.normal, impulses_[k], share);
        }
        const double part = contacts_.size() > 1 ? part_of_friction() : 1.0;
        for (std::size_t k = 0; k < contacts_.size(); ++k) {
            PairContact& contact = contacts_[k];
            const Vec3 along = impulses_[k] * contact.normal;
            if (part < 1.0) contact.impulse = along + part * (contact.impulse - along);
            apply_impulse(first(contact), second(contact), contact.normal, contact.impulse);
        }
        for (std::size_t k = 0; k < contacts_.size(); ++k) {
            PairContact& contact = contacts_[k];
            resist_rolling(law_of(contact), first(contact), second(contact), contact.normal, impulses_[k]);
        }
    }

private:
    [[nodiscard]] PairBody& first(const PairContact& contact) { return bodies_[contact.first]; }
    [[nodiscard]] PairBody& second(const PairContact& contact) { return bodies_[contact.second]; }
    [[nodiscard]] const PairMaterial& law_of(const PairContact& contact) {
        return laws_.of(first(contact).material, second(contact).material);
    }

    [[nodiscard]] std::vector<std::size_t> contacts_of_bodies() const {
        std::vector<std::size_t> counts(bodies_.size(), 0);
        for (const PairContact& contact : contacts_) ++counts[contact.first], ++counts[contact.second];
        return counts;
    }

    /// Returns the fraction of all friction impulses that adds no energy to the state after the normal impulses. Other
    /// contacts may reverse a slip, so full friction could add energy.
    [[nodiscard]] double part_of_friction() {
        const std::vector<PairBody> before = bodies_;
        const auto power = [&] {
            double sum = 0.0;
            for (std::size_t k = 0; k < contacts_.size(); ++k) {
                const PairContact& contact = contacts_[k];
                const Vec3 friction = contact.impulse - impulses_[k] * contact.normal;
                sum += dot(friction, relative_velocity(first(contact), second(contact), contact.normal));
            }
            return sum;
        };
        const auto apply_to_all = [&](bool is_friction) {
            for (std::size_t k = 0; k < contacts_.size(); ++k) {
                PairContact& contact = contacts_[k];
                const Vec3 along = impulses_[k] * contact.normal;
                apply_impulse(first(contact), second(contact), contact.normal,
                              is_friction ? contact.impulse - along : along);
            }
        };
        apply_to_all(false);
        const double at_first = power();
        apply_to_all(true);
        const double curvature = power() - at_first;  // the energy changes by f at_first + f^2 curvature / 2
        bodies_ = before;
        return curvature > 0.0 ? std::clamp(-2.0 * at_first / curvature, 0.0, 1.0) : 1.0;
    }

    /// Returns the additional normal impulse for the rebound, in N s.
    [[nodiscard]] double needed(std::size_t k) {
        const PairContact& contact = contacts_[k];
        const double inverse = effective_inverse_mass(first(contact), second(contact));
        const double separation_speed = dot(second(contact).velocity - first(contact).velocity, contact.normal);
        return inverse > 0.0 ? (targets_[k] - separation_speed) / inverse : 0.0;
    }

    void iterate() {
        double fastest = 0.0;
        for (const PairContact& contact : contacts_) fastest = std::max(fastest, std::fabs(contact.approach));
        for (int sweep = 0; sweep < kMostImpactSweeps; ++sweep) {
            double change = 0.0;
            for (std::size_t k = 0; k < contacts_.size(); ++k) {
                PairContact& contact = contacts_[k];
                const double next = std::max(0.0, impulses_[k] + needed(k));
                const double more = next - impulses_[k];
                impulses_[k] = next;
                apply_impulse(first(contact), second(contact), contact.normal, more * contact.normal);
                change = std::max(change, std::fabs(more) * effective_inverse_mass(first(contact), second(contact)));
            }
            if (change <= kImpactSolved * fastest) break;
        }
    }

    const PairMaterials& laws_;
    std::vector<PairBody>& bodies_;
    std::span<PairContact> contacts_;
    std::vector<double> impulses_;  // N s, along the normals
    std::vector<double> targets_;   // m/s, required separation speeds
};

}  // namespace

PairBody pair_body(const Vec3& position, const Vec3& velocity, const Vec3& spin, double mass, double radius,
                   bool is_fixed) {
    PairBody body{position, velocity, spin, 0.0, radius, 0.0, 0};
    if (is_fixed) return body;
    body.inverse_mass = 1.0 / mass;
    body.inverse_inertia = 2.5 / (mass * radius * radius);
    return body;
}

double approach_of(const PairBody& a, const PairBody& b) {
    const Vec3 along = b.position - a.position;
    return -dot(b.velocity - a.velocity, along) / length(along);
}

double rebound_speed(const PairMaterial& law, double resting_speed, double approach) {
    const double restitution = law.restitution_at(approach);
    const double rebound = restitution * approach;
    return restitution < 1.0 && rebound < resting_speed ? 0.0 : rebound;
}

void resolve_pair_impacts(const PairMaterials& laws, double resting_speed, std::vector<PairBody>& bodies,
                          std::span<PairContact> contacts) {
    ImpactProblem(laws, resting_speed, bodies, contacts).solve();
}

}  // namespace ricochet
