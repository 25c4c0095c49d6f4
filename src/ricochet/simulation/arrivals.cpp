// Adding particles: all threads examine them first, then they are inserted one by one.
#include <algorithm>
#include <utility>
#include <vector>

#include "ricochet/collision/overlap.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {
namespace {

/// Number of particles that a thread examines at a time, in some hundred microseconds.
constexpr std::size_t kArrivalBlock = 64;
/// Number of arrivals in memory at a time. An arrival takes as much memory as a particle.
constexpr std::size_t kArrivals = 16384;

bool is_in_range(const Vec3& position) { return is_finite(position) && max_abs(position) <= kLargestCoordinate; }

}  // namespace

/// Returns the overlap of a sphere at its position in the simulation.
std::optional<Overlap> Simulation::Impl::overlap_of(const Particle& particle) const {
    const Vec3 position = flush_tiny(particle.position);
    if (!is_in_range(position)) return std::nullopt;
    return deepest_overlap(world, bodies.get(), position, particle.radius, particle.birth_time);
}

void Simulation::Impl::prepare_radius(double radius) {
    world.prepare_radius(radius);
    if (bodies) bodies->prepare_radius(radius);
}

/// Notes the first particle that is born faster than light. Such a particle is allowed, and can hit others. Forces
/// must not accelerate particles beyond that speed.
void Simulation::Impl::note_speed(std::size_t i) {
    const double speed = length(particles().velocity[i]);
    if (!faster_than_light && speed > kMaxSpeed) faster_than_light = {particles().id[i], speed};
}

/// Returns true for a point on a surface. A sphere whose centre lies on a surface is in overlap.
bool Simulation::Impl::starts_on_surface(const Particle& particle) const {
    const Vec3 position = flush_tiny(particle.position);
    if (particle.radius > 0.0 || !is_in_range(position)) return false;
    ContactScratch scratch;
    const SurfaceGeometry geometry(world, scratch.plane_cache);
    const Path path = line_path(position, Vec3{}, 0.0);
    return find_first_contact(geometry, {path, 0.0}, scratch).near.starts_in_overlap();
}

/// Examines a particle, and moves it off surfaces of bodies on which it lies. The result depends only on surfaces, not
/// on other arrivals, so any thread can call it.
Arrival Simulation::Impl::arrival_of(Particle& particle) const {
    Arrival arrival;
    if (bodies && is_in_range(particle.position)) {
        const auto off = off_bodies(*bodies, flush_tiny(particle.position), std::max(0.0, particle.birth_time));
        if (off) particle.position = *off, arrival.starts_inside = true;
    }
    arrival.overlap = overlap_of(particle);
    if (arrival.overlap || starts_on_surface(particle)) arrival.starts_inside = true;
    const bool is_held = options.response == ResponseKind::exact && !options.flow && !response->keeps_sides();
    if (is_held && !arrival.overlap) arrival.contact = contact_of(particle);
    return arrival;
}

/// Returns the contact of a particle that touches surfaces at its birth.
ContactState Simulation::Impl::contact_of(const Particle& particle) const {
    const Vec3 position = flush_tiny(particle.position);
    if (!is_in_range(position) || particle.pinned) return {};
    if (const auto contact = contact_in(world, particle, position)) return *contact;
    if (!bodies) return {};
    const double time = std::max(0.0, particle.birth_time);
    for (const BodyId body : bodies_near(*bodies, position, particle.radius, time)) {
        const Vec3 local_position = bodies->pose(body, time).local_position(position);
        if (const auto contact = contact_in(bodies->world(body), particle, local_position)) return *contact;
    }
    return {};
}

/// Returns the contact with the surfaces of one frame, in which the particle is at a position. Nothing if it touches
/// none.
std::optional<ContactState> Simulation::Impl::contact_in(const CollisionWorld& of_frame, const Particle& particle,
                                                         const Vec3& position) const {
    ContactState contact;
    const double reach = kTouchingOffsets * contact_offset(position);
    for (const SurfaceId surface : surfaces_touched(of_frame, position, particle.radius, reach)) {
        // A random reflection answers each touch.
        if (materials[world.material_of(surface)].is_random()) return ContactState{};
        contact.surfaces[0] = surface;
        contact.count = 1;
        contact.cascade_left = ContactState::kPlaced;
    }
    return contact.count > 0 ? std::optional(contact) : std::nullopt;
}

void Simulation::Impl::add(Particle&& particle) {
    particle.id = store.next_id();
    Particle* const one = &particle;
    add_all({&one, 1});
}

void Simulation::Impl::add_all(std::span<Particle* const> added, const std::function<void(std::size_t)>& after) {
    for (const Particle* const particle : added) prepare_radius(particle->radius);
    for (std::size_t first = 0; first < added.size(); first += kArrivals) {
        const auto part = added.subspan(first, std::min(kArrivals, added.size() - first));
        std::vector<Arrival> arrivals(part.size());
        parallel_for_blocks(part.size(), kArrivalBlock, [&](std::size_t /*block*/, std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) arrivals[k] = arrival_of(*part[k]);
        });
        for (std::size_t k = 0; k < part.size(); ++k) {
            insert(std::move(*part[k]), arrivals[k]);
            if (after) after(first + k);
        }
    }
}

void Simulation::Impl::insert(Particle&& particle, const Arrival& arrival) {
    SimulationStatistics& statistics = recorder.statistics();
    statistics.started_in_overlap += arrival.overlap ? 1 : 0;
    statistics.started_inside += arrival.starts_inside ? 1 : 0;
    schedule.append(particle.pinned);
    free_flights.append();
    store.set_next_id(particle.id);
    store.append(std::move(particle));
    modules.each([](Module& module) { module.append(); });
    const std::size_t i = store.size() - 1;
    note_speed(i);
    if (offspring && inside_step) birth_records.push_back({particles().id[i], particles().origin[i]});
    if (!response->keeps_sides()) {
        if (arrival.overlap) {
            store.set_core(i, core_radius(*arrival.overlap, particles().position[i], particles().radius[i]));
        }
        if (arrival.contact.count > 0) store.set_contact(i, arrival.contact);
    } else if (is_finite(particles().position[i])) {
        response->first_sides(particles().position[i], store.sides_of(i));
    }
    ++statistics.emitted;
}

}  // namespace ricochet
