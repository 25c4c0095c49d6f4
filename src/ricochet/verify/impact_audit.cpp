#include "ricochet/verify/impact_audit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/verify/sphere_overlaps.h"

namespace ricochet::verify {
namespace {

/// A type with more digits than double, on machines that have one. The rounding errors of this check are then
/// negligible.
using Long = long double;

struct LongVec {
    Long x = 0;
    Long y = 0;
    Long z = 0;
};

LongVec wide(const Vec3& v) { return {v.x, v.y, v.z}; }
LongVec operator+(const LongVec& a, const LongVec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
LongVec operator-(const LongVec& a, const LongVec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
LongVec operator*(Long s, const LongVec& a) { return {s * a.x, s * a.y, s * a.z}; }
Long product(const LongVec& a, const LongVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
LongVec moment(const LongVec& a, const LongVec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Long size(const LongVec& a) { return std::sqrt(product(a, a)); }

Long inertia(const MetSphere& sphere) { return static_cast<Long>(sphere.mass) * sphere.radius * sphere.radius * 2 / 5; }

Long energy(const MetSphere& sphere, const RecordedMotion& motion) {
    const LongVec v = wide(motion.velocity);
    const LongVec w = wide(motion.spin);
    return (sphere.mass * product(v, v) + inertia(sphere) * product(w, w)) / 2;
}

class Audit {
public:
    Audit(const PairMeeting& meeting, const ImpactAudit& rules) : meeting_(meeting), rules_(rules) {}

    [[nodiscard]] bool is_wrong() const {
        for (const MetContact& contact : meeting_.contacts) {
            if (is_apart(contact) || pulls_or_drags(contact) || rebounds_otherwise(contact)) return true;
        }
        return spheres_are_wrong() || gains_energy();
    }

private:
    [[nodiscard]] const MetSphere& first(const MetContact& contact) const { return meeting_.spheres[contact.first]; }
    [[nodiscard]] const MetSphere& second(const MetContact& contact) const { return meeting_.spheres[contact.second]; }
    /// Returns the offset from the centre of the first sphere to the centre of the second.
    [[nodiscard]] LongVec between(const MetContact& contact) const {
        return wide(second(contact).before.position) - wide(first(contact).before.position);
    }
    [[nodiscard]] LongVec normal(const MetContact& contact) const {
        const LongVec apart = between(contact);
        return (1 / size(apart)) * apart;
    }
    /// Returns the sum of the speeds of both spheres. Rounding errors of an approach speed are proportional to this
    /// sum.
    [[nodiscard]] Long speeds(const MetContact& contact) const {
        return size(wide(first(contact).before.velocity)) + size(wide(second(contact).before.velocity));
    }

    [[nodiscard]] ImpactAudit::Pair law(const MetContact& contact) const {
        if (rules_.materials == 0)
            return {rules_.restitution, rules_.friction, rules_.rolling_friction, rules_.falls_from, rules_.falls_with};
        return rules_.by_materials[first(contact).material * rules_.materials + second(contact).material];
    }
    template <class Holds>
    [[nodiscard]] bool holds_for_all(const Holds& holds) const {
        return std::ranges::all_of(meeting_.contacts, [&](const MetContact& contact) { return holds(law(contact)); });
    }

    [[nodiscard]] bool is_apart(const MetContact& contact) const {
        const MetSphere& a = first(contact);
        const MetSphere& b = second(contact);
        const Long distance = size(between(contact));
        if (!(distance > 0) || !std::isfinite(static_cast<double>(distance))) return true;
        if (!rules_.has_exact_paths) return false;
        // Local: a tolerance of the audit, which does not affect the run.
        constexpr double kUlps = 64.0;
        const double tick = kUlps * std::numeric_limits<double>::epsilon();
        const double smaller = std::min(a.radius, b.radius);
        const double path_length = a.contact_path + b.contact_path;
        const Long reach = kMostMetOverlap * smaller + (path_length > 0.0 ? kBoundGap * (smaller + path_length) : 0.0) +
                           tick * std::max(max_abs(a.before.position), max_abs(b.before.position)) +
                           tick * std::fabs(meeting_.time) * speeds(contact);
        return !(distance - a.radius - b.radius <= reach);
    }

    /// Returns true if the impulse of a contact is attractive, or if its tangential part exceeds the limit of friction.
    [[nodiscard]] bool pulls_or_drags(const MetContact& contact) const {
        const LongVec impulse = wide(contact.impulse);
        const LongVec n = normal(contact);
        const Long normal_impulse = product(impulse, n);
        const Long drag = size(impulse - normal_impulse * n);
        const Long rounding = kPairBooks * size(impulse);
        return !(normal_impulse >= -rounding) || !(drag <= law(contact).friction * normal_impulse + rounding);
    }

    [[nodiscard]] Long departure(const MetContact& contact, bool is_after) const {
        const auto velocity = [&](const MetSphere& s) { return wide((is_after ? s.after : s.before).velocity); };
        return product(velocity(second(contact)) - velocity(first(contact)), normal(contact));
    }

    [[nodiscard]] static Long restitution_of(const ImpactAudit::Pair& law, Long approach) {
        if (law.falls_from == 0.0 || !(approach > law.falls_from)) return law.restitution;
        return law.restitution * std::pow(law.falls_from / approach, static_cast<Long>(law.falls_with));
    }

    [[nodiscard]] bool rubs() const {
        return !holds_for_all([](const ImpactAudit::Pair& pair) { return pair.friction == 0.0; });
    }
    [[nodiscard]] bool resists_rolling() const {
        return !holds_for_all([](const ImpactAudit::Pair& pair) { return pair.rolling_friction == 0.0; });
    }

    /// Returns true if a contact has a wrong rebound. The target is the rebound speed that follows from the
    /// restitution. A single contact must rebound with the target speed. If there are several contacts without
    /// friction, each must rebound with at least its target speed.
    [[nodiscard]] bool rebounds_otherwise(const MetContact& contact) const {
        const Long approach = -departure(contact, false);
        const Long rounding = kPairBooks * speeds(contact);
        const Long restitution = restitution_of(law(contact), approach);
        Long target = restitution * approach;
        const bool is_alone = meeting_.contacts.size() == 1;
        if (approach <= rounding || (!is_alone && rubs())) return false;
        if (first(contact).is_fixed && second(contact).is_fixed) return true;
        if (restitution < 1.0 && std::fabs(target - rules_.resting_speed) <= rounding) return false;
        if (restitution < 1.0 && target < rules_.resting_speed) target = 0;
        const Long more = departure(contact, true) - target;
        const Long allowed = is_alone ? rounding : 1000 * rounding;
        return is_alone ? !(std::fabs(more) <= allowed) : !(more >= -allowed);
    }

    [[nodiscard]] bool spheres_are_wrong() const {
        LongVec turning;
        Long turning_scale = 0;
        bool has_fixed = false;
        const bool is_resisted = resists_rolling();
        for (std::size_t k = 0; k < meeting_.spheres.size(); ++k) {
            const MetSphere& sphere = meeting_.spheres[k];
            LongVec given;
            LongVec turned;
            Long scale = 0;
            for (const MetContact& contact : meeting_.contacts) {
                if (contact.first != k && contact.second != k) continue;
                const LongVec impulse = wide(contact.impulse);
                given = given + (contact.second == k ? 1 : -1) * impulse;
                turned = turned - sphere.radius * moment(normal(contact), impulse);
                scale += size(impulse);
            }
            has_fixed = has_fixed || sphere.is_fixed;
            if (sphere.is_fixed) continue;
            const LongVec before = sphere.mass * wide(sphere.before.velocity);
            const LongVec after = sphere.mass * wide(sphere.after.velocity);
            if (!(size(after - before - given) <= kPairBooks * (scale + size(before) + size(after)))) return true;
            const LongVec spin_before = inertia(sphere) * wide(sphere.before.spin);
            const LongVec spin_after = inertia(sphere) * wide(sphere.after.spin);
            const LongVec off = spin_after - spin_before - turned;
            const Long off_scale = sphere.radius * scale + size(spin_before) + size(spin_after);
            if (!is_resisted && !(size(off) <= kPairAngularBooks * off_scale)) return true;
            turning = turning + off;
            turning_scale += off_scale;
        }
        // The moments of rolling resistance on two spheres are opposite, so they cancel in the sum. The moments on
        // fixed spheres are not in the sum, so there is no check with fixed spheres.
        return !has_fixed && !(size(turning) <= kPairAngularBooks * turning_scale);
    }

    /// Returns the work, in J, that fixed spheres of a contact do on the other sphere. A fixed sphere may move or
    /// rotate, so its impulse can do work.
    [[nodiscard]] Long work_of_fixed(const MetContact& contact) const {
        const auto surface_speed = [&](const MetSphere& sphere, Long side) {
            const LongVec arm = (side * sphere.radius) * normal(contact);
            return wide(sphere.before.velocity) + moment(wide(sphere.before.spin), arm);
        };
        const LongVec impulse = wide(contact.impulse);
        Long work = 0;
        if (first(contact).is_fixed) work += product(impulse, surface_speed(first(contact), 1));
        if (second(contact).is_fixed) work -= product(impulse, surface_speed(second(contact), -1));
        return work;
    }

    [[nodiscard]] bool gains_energy() const {
        Long before = 0;
        Long after = 0;
        for (const MetSphere& sphere : meeting_.spheres) {
            if (sphere.is_fixed) continue;
            before += energy(sphere, sphere.before);
            after += energy(sphere, sphere.after);
        }
        Long scale = before + after;
        for (const MetContact& contact : meeting_.contacts) {
            const Long work = work_of_fixed(contact);
            before += work;
            scale += std::fabs(work);
        }
        const Long rounding = kPairBooks * scale;
        if (!(after - before <= rounding)) return true;
        const bool keeps = !rubs() && !resists_rolling() && holds_for_all([](const ImpactAudit::Pair& pair) {
            return pair.restitution == 1.0 && pair.falls_from == 0.0;
        });
        return keeps && !(before - after <= rounding);
    }

    const PairMeeting& meeting_;
    const ImpactAudit& rules_;
};

}  // namespace

bool is_wrong(const PairMeeting& meeting, const ImpactAudit& rules) { return Audit(meeting, rules).is_wrong(); }

}  // namespace ricochet::verify
