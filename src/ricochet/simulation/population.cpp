#include "ricochet/simulation/population.h"

#include <algorithm>
#include <utility>

#include "ricochet/collision/contact_query.h"
#include "ricochet/core/merging_reader.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/rank_share.h"

namespace ricochet {
namespace {

/// Largest number of arrivals in memory at the same time. An arrival needs as much memory as a particle.
constexpr std::size_t kArrivals = 16384;

/// Particles per unit of parallel work, which takes some hundred microseconds.
constexpr std::size_t kArrivalBlock = 64;

/// Returns true if contacts are searched at a birth, because the response lets particles slide and rest exactly.
bool finds_contacts(const SimulationOptions& options, const Response& response) {
    return options.response == ResponseKind::exact && !options.flow && !response.keeps_sides();
}

/// Returns true if particles look for free space around them (clear_flight.h).
bool keeps_clear_spaces(const PopulationParts& parts) {
    const ResponseRules& rules = parts.response.rules();
    return parts.options.response == ResponseKind::exact && !parts.options.flow && rules.bodies.empty() &&
           !rules.world.triangles().empty() && !rules.forces.is_uniform();
}

/// Returns true for a point on a surface. A sphere whose centre lies on a surface is in overlap.
bool starts_on_surface(const CollisionScene& scene, const Particle& particle) {
    const Vec3 position = flush_tiny(particle.position);
    if (particle.radius > 0.0 || !is_in_range(position)) return false;
    ContactScratch scratch;
    const SurfaceGeometry geometry(scene.world(), scratch.plane_cache);
    const Path path = line_path(position, Vec3{}, 0.0);
    return find_first_contact(geometry, {path, 0.0}, scratch).near.starts_in_overlap();
}

/// Returns a particle's contact with the surfaces of a frame, at a position in it; nothing if it touches none.
std::optional<ContactState> contact_in(const CollisionScene& scene, const CollisionWorld& of_frame,
                                       const Particle& particle, const Vec3& position) {
    ContactState contact;
    const double reach = kTouchingOffsets * contact_offset(position);
    for (const SurfaceId surface : surfaces_touched(of_frame, position, particle.radius, reach)) {
        // A random reflection resolves each touch, so no contact is kept.
        if (scene.materials()[scene.world().material_of(surface)].is_random()) return ContactState{};
        contact.surfaces[0] = surface;
        contact.count = 1;
        contact.cascade_left = ContactState::kPlaced;
    }
    return contact.count > 0 ? std::optional(contact) : std::nullopt;
}

/// Returns the contact of a particle that touches surfaces at its birth.
ContactState contact_of(const CollisionScene& scene, const Particle& particle) {
    const Vec3 position = flush_tiny(particle.position);
    if (!is_in_range(position) || particle.pinned) return {};
    if (const auto contact = contact_in(scene, scene.world(), particle, position)) return *contact;
    const MovingColliders& moving = scene.moving();
    const double time = std::max(0.0, particle.birth_time);
    for (const BodyId body : bodies_near(moving, position, particle.radius, time)) {
        const Vec3 local_position = moving.local_position(body, position, time);
        if (const auto contact = contact_in(scene, moving.world(body), particle, local_position)) return *contact;
    }
    return {};
}

}  // namespace

/// Test results of a new particle. They depend only on surfaces, and not on other new particles.
struct Population::Arrival {
    std::optional<Overlap> overlap;  ///< overlap with a surface
    bool starts_inside = false;      ///< true if in overlap, on a surface, or moved off a surface
    ContactState contact;            ///< contact with the surfaces that touch the particle
};

Population::Population(ParticleStore store, const AccelerationSwitches& acceleration, double particle_bytes,
                       const PopulationParts& parts)
    : store_(std::move(store)),
      schedule_(parts.clock, keeps_clear_spaces(parts)),
      flights_(store_, schedule_, parts.response.rules(), parts.modules.hooks()),
      acceleration_(acceleration),
      memory_(particle_bytes),
      parts_(parts) {
    allow_sleep();
}

void Population::allow_sleep() {
    const bool is_watched = !parts_.scene.moving().empty() && parts_.options.verify;
    store_.set_may_sleep(acceleration_.sleeping && parts_.response.rules().forces.is_steady() && !is_watched);
}

void Population::reserve(std::size_t more) {
    store_.reserve(more);
    schedule_.reserve(more);
    flights_.reserve(more);
}

void Population::add(std::span<Particle* const> added, const std::function<void(std::size_t)>& after) {
    for (const Particle* const particle : added) parts_.scene.prepare_radius(particle->radius);
    for (std::size_t first = 0; first < added.size(); first += kArrivals) {
        const auto part = added.subspan(first, std::min(kArrivals, added.size() - first));
        std::vector<Arrival> arrivals(part.size());
        parallel_for(part.size(), kArrivalBlock, [&](std::size_t k) { arrivals[k] = arrival_of(*part[k]); });
        for (std::size_t k = 0; k < part.size(); ++k) {
            insert(std::move(*part[k]), arrivals[k]);
            if (after) after(first + k);
        }
    }
}

/// Tests a particle. Moves it off the surfaces of moving colliders on which it lies.
Population::Arrival Population::arrival_of(Particle& particle) const {
    Arrival arrival;
    if (!parts_.scene.moving().empty() && is_in_range(particle.position)) {
        const auto off =
            off_bodies(parts_.scene.moving(), flush_tiny(particle.position), std::max(0.0, particle.birth_time));
        if (off) particle.position = *off, arrival.starts_inside = true;
    }
    arrival.overlap = parts_.scene.overlap_of(particle);
    if (arrival.overlap || starts_on_surface(parts_.scene, particle)) arrival.starts_inside = true;
    if (finds_contacts(parts_.options, parts_.response) && !arrival.overlap)
        arrival.contact = contact_of(parts_.scene, particle);
    return arrival;
}

void Population::insert(Particle&& particle, const Arrival& arrival) {
    schedule_.append(particle.pinned);
    flights_.append();
    store_.set_next_id(particle.id);
    store_.append(std::move(particle));
    parts_.modules.each([](Module& module) { module.append(); });
    const std::size_t i = size() - 1;
    const Vec3& position = particles().position[i];
    if (!parts_.response.keeps_sides()) {
        if (arrival.overlap) {
            store_.cores().set(i, core_radius(*arrival.overlap, position, particles().radius[i]), size());
        }
        if (arrival.contact.count > 0) store_.set_contact(i, arrival.contact);
    } else if (is_finite(position)) {
        parts_.response.first_sides(position, store_.sides_of(i));
    }
    SimulationStatistics& statistics = parts_.recorder.statistics();
    statistics.started_in_overlap += arrival.overlap ? 1 : 0;
    statistics.started_inside += arrival.starts_inside ? 1 : 0;
    ++statistics.emitted;
}

void Population::compact(const std::vector<std::uint8_t>& keep) {
    schedule_.compact(keep);
    flights_.compact(keep);
    store_.compact(keep);
    parts_.modules.each([&](Module& module) { module.compact(keep); });
    bind();
}

// Keeps the query schedule of the particles that are already in the store.
void Population::merge(std::vector<std::vector<std::byte>> parts) {
    const std::vector<std::uint64_t> here = particles().id;
    parts.insert(parts.begin(), archived_bytes(store_));
    ParticleStore all = store_.empty_copy();
    MergingReader reader(parts);
    all.archive(reader);
    store_ = std::move(all);
    std::vector<std::size_t> from(size(), QuerySchedule::kNew);
    std::size_t next = 0;
    for (std::size_t i = 0; i < from.size() && next < here.size(); ++i) {
        if (particles().id[i] == here[next]) from[i] = next++;
    }
    schedule_.rearrange(from);
    bind();
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (from[i] != QuerySchedule::kNew) continue;
        parts_.scene.prepare_radius(particles().radius[i]);
        if (store_.is_fixed(i) || store_.is_asleep(i)) schedule_.leave_alone(i);
    }
}

void Population::bind() const {
    parts_.modules.each([](Module& module) { module.bind(); });
}

// Reorders the active set only for `exact`. Others sum depths block by block, with a rounding that depends on blocks.
ActiveSet Population::advance(const ParticleRange& range, const TimeSpan& part, std::vector<BlockRecord>& blocks) {
    ActiveSet active = flights_.advance(range, part, blocks);
    if (parts_.options.response != ResponseKind::exact) return active;
    const CollisionWorld& world = parts_.scene.world();
    active.cut_evenly();
    if (acceleration_.spatial_order && active.is_worth_sorting(size(), world.triangles().size())) {
        active.sort_by_position(particles().position, world.triangle_bounds());
    }
    return active;
}

bool Population::may_defer() const {
    return acceleration_.look_ahead && acceleration_.deferred_steps && parts_.modules.allow_deferred_steps();
}

void Population::wake(std::size_t i) {
    schedule_.forget(i);
    flights_.wake(i);
}

void Population::forget_queries() {
    schedule_.reset(size(), keeps_clear_spaces(parts_));
    for (std::size_t i = 0; i < size(); ++i) {
        if (store_.is_fixed(i) || store_.is_asleep(i)) schedule_.leave_alone(i);
    }
}

}  // namespace ricochet
