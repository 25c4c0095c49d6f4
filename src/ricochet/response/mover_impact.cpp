#include <cmath>
#include <utility>

#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/mover.h"

namespace ricochet {
namespace {

/// Passes over the surfaces of a corner until none is approached; sharper corners take the velocity into the corner
/// away.
constexpr int kCornerPasses = 16;

/// Boltzmann's constant, J/K (exact by the SI of 2019).
constexpr double kBoltzmann = 1.380649e-23;

}  // namespace

/// Responds to an impact. Returns the next contact when the particle slid into one.
std::optional<Contact> Mover::answer(const Flight& flight, const Contact& contact) {
    ++outcome_.bounces;
    for (const ContactSurface& surface : contact.all()) note_recent(surface.surface);
    const Motion arriving{state_.velocity, particle_.spin};
    reflect(contact);
    if (outcome_.absorbed) return std::nullopt;
    const ContactSurface* const support = support_of(flight, contact, arriving);
    const bool is_stuck = std::exchange(remaining_at_contact_, remaining_) == remaining_;
    const bool is_slow = support != nullptr && (is_stuck || length(arriving.velocity) < rules_.settings_.resting_speed);
    slow_contacts_ = is_slow ? slow_contacts_ + 1 : 0;
    if (support == nullptr) return std::nullopt;
    gather_touched(contact);
    if (slow_contacts_ > kMostSlowContacts) {
        shares_ = {};
        rest(flight.kick_duration > 0.0 ? Vec3{} : acceleration_now(flight), false);
        return std::nullopt;
    }
    return stay_in_contact(flight, *support, arriving);
}

const Material& Mover::material_of(SurfaceId surface) const {
    return rules_.materials_[rules_.world_.material_of(surface)];
}

void Mover::push(SurfaceId surface, const Vec3& velocity_change, bool impact) {
    scratch_.hits.push_back({surface, -state_.mass * velocity_change, impact});
}

void Mover::record(const ContactSurface& surface, const Vec3& velocity_before) {
    if (!scratch_.record_contacts) return;
    scratch_.records.push_back({state_.time, particle_.id, surface.surface, state_.position, surface.normal,
                                velocity_before, state_.velocity, state_.mass, state_.radius});
}

/// Bounces off every surface of the contact that is approached, until none is.
void Mover::reflect(const Contact& contact) {
    bool any_push = false;
    for (int pass = 0; pass < kCornerPasses; ++pass) {
        bool approached = false;
        for (const ContactSurface& surface : contact.all()) {
            if (!(dot(state_.velocity, surface.normal) < 0.0)) continue;
            approached = true;
            any_push = true;
            const Vec3 before = state_.velocity;
            reflect_off(surface, material_of(surface.surface));
            push(surface.surface, state_.velocity - before, pass == 0);
            record(surface, before);
            if (outcome_.absorbed) return;
        }
        if (approached) continue;
        if (!any_push) {  // a touch without approach still is an impact
            push(contact.first().surface, Vec3{}, true);
            record(contact.first(), state_.velocity);
        }
        return;
    }
    push_out_of_corner(contact);
}

void Mover::reflect_off(const ContactSurface& surface, const Material& material) {
    const double restitution = material.restitution_at(-dot(state_.velocity, surface.normal));
    const Motion motion{state_.velocity, particle_.spin};
    const Motion after = material.is_random()
                             ? random_reflection(surface, material)
                             : bounce(motion, state_.radius, surface.normal, restitution, material.friction);
    state_.velocity = after.velocity;
    particle_.spin = after.spin;
}

/// Absorbs, or reflects by the cosine law or as a mirror, as this particle's own random numbers say (Maxwell's model:
/// J. C. Maxwell, "On stresses in rarified gases", Phil. Trans. 170, 1879).
Motion Mover::random_reflection(const ContactSurface& surface, const Material& material) {
    RandomSequence random(rules_.settings_.seed, kImpactStream, particle_.id, particle_.draws);
    Motion motion{state_.velocity, particle_.spin};
    if (material.absorption > 0.0 && random.uniform() < material.absorption) {
        outcome_.absorbed = true;
        motion = {};
    } else if (material.diffuse > 0.0 && random.uniform() < material.diffuse) {
        motion.velocity =
            material.wall_temperature
                ? thermal_velocity(surface.normal, std::sqrt(kBoltzmann * *material.wall_temperature / state_.mass),
                                   random)
                : length(motion.velocity) * cosine_direction(surface.normal, random);
    } else {
        const double restitution = material.restitution_at(-dot(motion.velocity, surface.normal));
        motion = bounce(motion, state_.radius, surface.normal, restitution, material.friction);
    }
    particle_.draws = random.draws();
    return motion;
}

void Mover::push_out_of_corner(const Contact& contact) {
    std::array<Vec3, 3> normals;
    std::size_t count = 0;
    for (const ContactSurface& surface : contact.all()) {
        if (count < normals.size()) normals[count++] = surface.normal;
    }
    const Vec3 before = state_.velocity;
    state_.velocity = project_off(before, {normals.data(), count});
    push(contact.first().surface, state_.velocity - before, false);
    record(contact.first(), before);
}

}  // namespace ricochet
