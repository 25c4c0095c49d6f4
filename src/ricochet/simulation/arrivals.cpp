#include "ricochet/simulation/arrivals.h"

#include <algorithm>

#include "ricochet/collision/contact_query.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Number of particles that a thread examines at a time, in some hundred microseconds.
constexpr std::size_t kArrivalBlock = 64;

}  // namespace

std::vector<Arrival> Arrivals::examine(std::span<Particle* const> particles) const {
    std::vector<Arrival> arrivals(particles.size());
    parallel_for_blocks(arrivals.size(), kArrivalBlock, [&](std::size_t /*block*/, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) arrivals[k] = examine(*particles[k]);
    });
    return arrivals;
}

Arrival Arrivals::examine(Particle& particle) const {
    Arrival arrival;
    if (scene_.moving() != nullptr && is_in_range(particle.position)) {
        const auto off =
            off_bodies(*scene_.moving(), flush_tiny(particle.position), std::max(0.0, particle.birth_time));
        if (off) particle.position = *off, arrival.starts_inside = true;
    }
    arrival.overlap = scene_.overlap_of(particle);
    if (arrival.overlap || starts_on_surface(particle)) arrival.starts_inside = true;
    if (finds_contacts_ && !arrival.overlap) arrival.contact = contact_of(particle);
    return arrival;
}

/// Returns true for a point on a surface. A sphere whose centre lies on a surface is in overlap.
bool Arrivals::starts_on_surface(const Particle& particle) const {
    const Vec3 position = flush_tiny(particle.position);
    if (particle.radius > 0.0 || !is_in_range(position)) return false;
    ContactScratch scratch;
    const SurfaceGeometry geometry(scene_.world(), scratch.plane_cache);
    const Path path = line_path(position, Vec3{}, 0.0);
    return find_first_contact(geometry, {path, 0.0}, scratch).near.starts_in_overlap();
}

/// Returns the contact of a particle that touches surfaces at its birth.
ContactState Arrivals::contact_of(const Particle& particle) const {
    const Vec3 position = flush_tiny(particle.position);
    if (!is_in_range(position) || particle.pinned) return {};
    if (const auto contact = contact_in(scene_.world(), particle, position)) return *contact;
    if (scene_.moving() == nullptr) return {};
    const MovingColliders& moving = *scene_.moving();
    const double time = std::max(0.0, particle.birth_time);
    for (const BodyId body : bodies_near(moving, position, particle.radius, time)) {
        const Vec3 local_position = moving.pose(body, time).local_position(position);
        if (const auto contact = contact_in(moving.world(body), particle, local_position)) return *contact;
    }
    return {};
}

/// Returns the contact with the surfaces of one frame, in which the particle is at a position. Nothing if it touches
/// none.
std::optional<ContactState> Arrivals::contact_in(const CollisionWorld& of_frame, const Particle& particle,
                                                 const Vec3& position) const {
    ContactState contact;
    const double reach = kTouchingOffsets * contact_offset(position);
    for (const SurfaceId surface : surfaces_touched(of_frame, position, particle.radius, reach)) {
        // A random reflection answers each touch.
        if (scene_.materials()[scene_.world().material_of(surface)].is_random()) return ContactState{};
        contact.surfaces[0] = surface;
        contact.count = 1;
        contact.cascade_left = ContactState::kPlaced;
    }
    return contact.count > 0 ? std::optional(contact) : std::nullopt;
}

}  // namespace ricochet
