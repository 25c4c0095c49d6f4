#include "ricochet/simulation/offspring.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation/cloud_motion.h"
#include "ricochet/simulation/flight_knots.h"

namespace ricochet {
namespace {

/// Parents per unit of parallel work.
constexpr std::size_t kBlock = 256;

}  // namespace

/// Path of one particle between before_move() and after_move(), as flights between knots.
struct Offspring::Trajectory {
    Particle particle;      ///< the particle in its last state
    std::size_t entry = 0;  ///< index relative to first_
    std::vector<FlightKnot> knots;
    std::span<const ContactRecord> records;
    bool shattered = false;
    bool died = false;

    [[nodiscard]] double begin() const { return knots.front().time; }
    [[nodiscard]] double end() const { return knots.back().time; }
    [[nodiscard]] Particle at(const Vec3& position, const Vec3& velocity) const {
        Particle parent = particle;
        parent.position = position;
        parent.velocity = velocity;
        return parent;
    }
    [[nodiscard]] Particle at(double time, const CollisionWorld& world, ContactScratch& scratch) const;
    /// Returns an event for children of an emitter. parent: the particle at the event.
    [[nodiscard]] SpawnEvent event(const Emitter& emitter, double time, std::uint32_t first_ordinal,
                                   std::uint32_t count, bool share, Particle parent) const {
        const Claim claim{time,        parent.id, emitter.number(), first_ordinal, count, parent.origin.generation,
                          parent.mass, share};
        return {claim, std::move(parent), entry};
    }
};

Particle Offspring::Trajectory::at(double time, const CollisionWorld& world, ContactScratch& scratch) const {
    std::size_t k = 0;
    while (k + 2 < knots.size() && knots[k + 1].time <= time) ++k;
    const FlightKnot& a = knots[k];
    if (k + 1 == knots.size() || !(knots[k + 1].time > a.time)) return at(a.position, a.after);
    const FlightKnot& b = knots[k + 1];
    const PhaseState state = state_between(a, b, time);
    const bool is_in_sight =
        is_clear(world, scratch, a.position, state.position) || is_clear(world, scratch, b.position, state.position);
    return is_in_sight ? at(state.position, state.velocity) : at(a.position, a.after);
}

Offspring::Offspring(const Parts& parts) : parts_(parts), children_of_(parts.emitters.size()) {
    const std::vector<Emitter>& emitters = parts.emitters;
    for (const Emitter& emitter : emitters) {
        const auto& rule = emitter.description().parent;
        if (!rule) continue;
        if (rule->emitter >= emitters.size()) {
            throw InputError(fmt::format("emitter '{}': its parent is not there", emitter.description().name));
        }
        children_of_[rule->emitter].push_back(emitter.number());
        if (rule->recursive && rule->emitter != emitter.number()) {
            children_of_[emitter.number()].push_back(emitter.number());
        }
    }
    for (const auto& children : children_of_) {
        for (const BirthEvent event : {BirthEvent::death, BirthEvent::impact}) {
            const auto shares = std::ranges::count_if(children, [&](std::uint32_t child) {
                const ParentRule& rule = *emitters[child].description().parent;
                return rule.share && rule.on == event;
            });
            if (shares > 1) throw InputError("two emitters divide the same parents into fragments at the same event");
        }
    }
}

double Offspring::shatter_impulse(const Particles& particles, std::size_t i) const {
    const Origin& origin = particles.origin[i];
    if (origin.emitter == kNoEmitter || origin.generation >= parts_.options.max_depth) {
        return std::numeric_limits<double>::infinity();
    }
    for (const std::uint32_t child : children_of_[origin.emitter]) {
        const ParentRule& rule = *parts_.emitters[child].description().parent;
        if (rule.share && rule.on == BirthEvent::impact) return rule.threshold_impulse;
    }
    return std::numeric_limits<double>::infinity();
}

void Offspring::before_move(const Particles& particles, std::size_t first, std::span<const SideMemory> sides) {
    first_ = first;
    const auto begin = static_cast<std::ptrdiff_t>(first);
    positions_.assign(particles.position.begin() + begin, particles.position.end());
    velocities_.assign(particles.velocity.begin() + begin, particles.velocity.end());
    sides_.assign(sides.begin(), sides.end());
}

Offspring::Trajectory Offspring::trajectory_of(const Particles& particles, std::size_t i, double from, double to,
                                               std::span<const ContactRecord> records) const {
    Trajectory trajectory;
    trajectory.particle = particles.at(i);
    trajectory.entry = i - first_;
    trajectory.records = records;
    const PhaseState start{positions_[i - first_], velocities_[i - first_]};
    if (clouds_ != nullptr) {
        const auto known = clouds_->knots_of(particles.id[i]);  // knots of cloud particles contain the impacts too
        trajectory.knots.assign(known.begin(), known.end());
    }
    if (trajectory.knots.empty()) trajectory.knots = flight_knots(particles, i, start, from, to, records);
    const double death = trajectory.particle.birth_time + trajectory.particle.lifetime;
    trajectory.shattered = particles.absorbed[i] == kShattered;
    trajectory.died = !trajectory.shattered && (particles.absorbed[i] != 0 || death <= to);
    return trajectory;
}

// Puts the births beyond `most` into one event. All are refused, because the earlier ones fill the population.
void Offspring::add_life(const Emitter& emitter, const Trajectory& trajectory, std::uint64_t most,
                         std::vector<SpawnEvent>& events) const {
    thread_local ContactScratch scratch;
    const LifeBirths births = births_in_life(emitter, trajectory.particle, trajectory.begin(), trajectory.end(), most);
    for (const LifeBirth& birth : births.first) {
        events.push_back(trajectory.event(emitter, birth.time, birth.ordinal, 1, false,
                                          trajectory.at(birth.time, parts_.scene.world(), scratch)));
    }
    if (births.more == 0) return;
    const double time = births.first.empty() ? trajectory.end() : births.first.back().time;
    events.push_back(trajectory.event(emitter, time, std::numeric_limits<std::uint32_t>::max(), births.more, false,
                                      trajectory.particle));
}

void Offspring::add_impacts(const Emitter& emitter, const Trajectory& trajectory, Origin& origin,
                            std::vector<SpawnEvent>& events) const {
    const ParentRule& rule = *emitter.description().parent;
    for (const ContactRecord& record : trajectory.records) {
        const bool is_last = &record == &trajectory.records.back();
        const double impulse = record.mass * length(record.velocity_after - record.velocity_before);
        const bool ends_here = rule.share && trajectory.shattered && is_last;
        // A parent that can shatter has births only then. If it is too deep for that, they are refused here.
        const bool refused =
            rule.share && origin.generation >= parts_.options.max_depth && impulse >= rule.threshold_impulse;
        if (!ends_here && !refused && (rule.share || impulse < rule.threshold_impulse)) continue;
        std::uint32_t count = children_of_event(emitter, trajectory.particle, origin.birth_impacts++);
        if (rule.share) count = std::max(count, 1U);
        events.push_back(trajectory.event(emitter, record.time, origin.impact_children, count, rule.share,
                                          trajectory.at(record.position, record.velocity_after)));
        origin.impact_children += count;
    }
}

void Offspring::add_death(const Emitter& emitter, const Trajectory& trajectory, std::vector<SpawnEvent>& events) const {
    if (!trajectory.died) return;
    const ParentRule& rule = *emitter.description().parent;
    std::uint32_t count = children_of_event(emitter, trajectory.particle, 0);
    if (rule.share) count = std::max(count, 1U);
    const FlightKnot& last = trajectory.knots.back();
    // Children of a parent that a surface has absorbed start with the parent's velocity of arrival. Fragments of this
    // parent start at rest, because the surface has already received the parent's momentum.
    const bool absorbed = !trajectory.records.empty() && last.time == trajectory.records.back().time;
    events.push_back(
        trajectory.event(emitter, last.time, 0, count, rule.share,
                         trajectory.at(last.position, absorbed && !rule.share ? last.before : last.after)));
}

void Offspring::add_birth(const Emitter& emitter, const Trajectory& trajectory, std::vector<SpawnEvent>& events) const {
    const std::uint64_t count =
        std::min<std::uint64_t>(children_of_event(emitter, trajectory.particle, 0), emitter.description().limit);
    const FlightKnot& first = trajectory.knots.front();
    events.push_back(trajectory.event(emitter, first.time, 0, static_cast<std::uint32_t>(count), false,
                                      trajectory.at(first.position, first.after)));
}

std::vector<Child> Offspring::after_move(Particles& particles, double from, double to,
                                         std::vector<ContactRecord> records, OffspringCounts& counts) const {
    const RecordsByParticle sorted(std::move(records));
    const std::size_t count = positions_.size();
    std::vector<std::vector<SpawnEvent>> blocks((count + kBlock - 1) / kBlock);
    const std::uint64_t room = room_below(parts_.options.most_particles, parts_.share.living(particles.size()));
    const std::uint64_t fitting = parts_.memory.room(particles.size());
    std::atomic<std::uint64_t> gathered{0};
    parallel_for_blocks(count, kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        std::size_t counted = 0;
        for (std::size_t i = first_ + begin; i < first_ + end; ++i) {
            Origin& origin = particles.origin[i];
            if (particles.frozen[i] != 0 || origin.emitter == kNoEmitter || children_of_[origin.emitter].empty())
                continue;
            const Trajectory trajectory = trajectory_of(particles, i, from, to, sorted.of(particles.id[i]));
            for (const std::uint32_t child : children_of_[origin.emitter]) {
                const Emitter& emitter = parts_.emitters[child];
                const BirthEvent on = emitter.description().parent->on;
                if (on == BirthEvent::life) {
                    add_life(emitter, trajectory, std::min(room, fitting + 1), blocks[block]);
                }
                if (on == BirthEvent::impact) add_impacts(emitter, trajectory, origin, blocks[block]);
                if (on == BirthEvent::death) add_death(emitter, trajectory, blocks[block]);
                if (on == BirthEvent::birth && trajectory.particle.birth_time >= from) {
                    add_birth(emitter, trajectory, blocks[block]);
                }
            }
            // Events are limited like particles, because an event needs no more memory than a particle.
            const std::uint64_t more = blocks[block].size() - std::exchange(counted, blocks[block].size());
            if (gathered.fetch_add(more, std::memory_order_relaxed) + more > fitting + count) {
                parts_.memory.refuse_to_grow(particles.size());
            }
        }
    });
    std::vector<SpawnEvent> events;
    for (std::vector<SpawnEvent>& block : blocks) {
        events.insert(events.end(), std::make_move_iterator(block.begin()), std::make_move_iterator(block.end()));
    }
    return spawn(events, particles.size(), counts);
}

/// Decides how many children each event may have, in the order of the events.
void Offspring::allot(std::vector<Claim>& claims, std::uint64_t living, std::uint64_t most_that_fit,
                      OffspringCounts& counts) const {
    for (Claim& claim : claims) {
        if (claim.generation >= parts_.options.max_depth) {
            counts.refused_by_depth += claim.count;
            continue;
        }
        if (claim.share) --living;  // fragments replace their parent
        const std::uint64_t room = room_below(parts_.options.most_particles, living);
        const std::uint32_t most = claim.share ? most_fragments(claim.mass) : claim.count;
        claim.allowed = static_cast<std::uint32_t>(
            std::min<std::uint64_t>({claim.count, most, std::max<std::uint64_t>(room, claim.share ? 1 : 0)}));
        claim.first = counts.children;
        counts.refused_by_population += claim.count - claim.allowed;
        if (claim.allowed > room_below(most_that_fit, living)) parts_.memory.refuse_to_grow(living);
        living += claim.allowed;
        counts.children += claim.allowed;
    }
}

/// Makes the decisions of allot() on each of several ranks, from the claims of all. A parent's events are on one rank.
void Offspring::allot_together(std::vector<Claim>& mine, std::size_t here, OffspringCounts& counts) const {
    const auto rank = static_cast<std::uint32_t>(parts_.share.ranks().rank());
    for (std::size_t k = 0; k < mine.size(); ++k) mine[k].rank = rank, mine[k].event = k;
    std::vector<Claim> all = gather_list_to_all(parts_.share.ranks(), mine);
    std::ranges::stable_sort(all, [](const Claim& a, const Claim& b) { return a.precedes(b); });
    allot(all, parts_.share.living(here), std::numeric_limits<std::uint64_t>::max(), counts);
    std::uint64_t born_here = 0;
    for (const Claim& claim : all) {
        if (claim.rank != rank) continue;
        mine[claim.event] = claim;
        born_here += claim.allowed;
    }
    if (born_here > parts_.memory.room(here)) parts_.memory.refuse_to_grow(here);
}

Child Offspring::child_of(const SpawnEvent& event, Particle&& particle, std::uint64_t number) const {
    const std::size_t colliders = positions_.empty() ? 0 : sides_.size() / positions_.size();
    const auto sides = std::span(sides_).subspan(event.entry * colliders, colliders);
    const bool is_fragment =
        event.claim.share && parts_.emitters[event.claim.emitter].description().parent->on == BirthEvent::impact;
    return {std::move(particle), positions_[event.entry], sides, is_fragment, number, std::nullopt};
}

/// Adds a child of a cloud. If no position is free, the number of the child stays unused.
void Offspring::add_cloud_child(const SpawnEvent& event, std::uint32_t ordinal, std::uint64_t number,
                                std::vector<Child>& children, OffspringCounts& counts) const {
    const auto has_place = [&](const Particle& child) { return parts_.scene.has_room_beside(event.parent, child); };
    std::optional<CloudChild> made =
        make_cloud_child(parts_.emitters[event.claim.emitter], event.parent, ordinal, event.claim.time, has_place);
    if (!made) {
        ++counts.refused_by_overlap;
        return;
    }
    children.push_back(child_of(event, std::move(made->particle), number));
    children.back().cloud = CloudMembership{event.parent.id, made->offset};
}

std::vector<Child> Offspring::spawn(std::vector<SpawnEvent>& events, std::size_t here, OffspringCounts& counts) const {
    std::ranges::stable_sort(events,
                             [](const SpawnEvent& a, const SpawnEvent& b) { return a.claim.precedes(b.claim); });
    std::vector<Claim> claims;
    claims.reserve(events.size());
    for (const SpawnEvent& event : events) claims.push_back(event.claim);
    if (parts_.share.is_alone()) {
        allot(claims, here, parts_.memory.most(), counts);
    } else {
        allot_together(claims, here, counts);
    }
    std::vector<Child> children;
    std::size_t born_here = 0;
    for (const Claim& claim : claims) born_here += claim.allowed;
    children.reserve(born_here);
    for (std::size_t i = 0; i < events.size(); ++i) {
        const SpawnEvent& event = events[i];
        const Claim& claim = claims[i];
        if (claim.allowed == 0) continue;
        const Emitter& emitter = parts_.emitters[claim.emitter];
        std::uint64_t number = claim.first;
        if (claim.share) {
            for (Particle& fragment :
                 make_fragments(emitter, event.parent, claim.allowed, claim.first_ordinal, claim.time)) {
                children.push_back(child_of(event, std::move(fragment), number++));
            }
            continue;
        }
        for (std::uint32_t k = 0; k < claim.allowed; ++k) {
            const std::uint32_t ordinal = claim.first_ordinal + k;
            if (emitter.description().parent->cloud) {
                add_cloud_child(event, ordinal, number++, children, counts);
            } else {
                children.push_back(child_of(event, make_child(emitter, event.parent, ordinal, claim.time), number++));
            }
        }
    }
    return children;
}

}  // namespace ricochet
