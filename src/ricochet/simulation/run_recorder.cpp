#include "ricochet/simulation/run_recorder.h"

#include <utility>
#include <variant>

#include "ricochet/core/algorithms.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/particle_store.h"
#include "ricochet/verify/rebound.h"

namespace ricochet {
namespace {

/// Number of hits between the prefetch of a surface's totals and their change.
constexpr std::size_t kPrefetchDistance = 8;

/// Adds `more` to `sum` without rounding.
void add_words(FixedPointSum& sum, const FixedPointSum& more) {
    const auto [low, high] = sum.words();
    const auto [low_more, high_more] = more.words();
    const std::uint64_t carry = low + low_more < low ? 1 : 0;
    sum.set_words({low + low_more, high + high_more + carry});
}

/// Returns the entries of one list of all blocks in the order of particles, whatever the order of moves.
template <class Entry>
std::vector<Entry> in_order_of_particles(const std::vector<BlockRecord>& blocks,
                                         std::vector<Entry> BlockRecord::*list) {
    std::vector<Entry> all = joined(blocks, list);
    std::ranges::stable_sort(all, {}, &Entry::particle);
    return all;
}

}  // namespace

std::uint64_t SurfaceTotals::add(std::span<const SurfaceHit> hits) {
    if (empty()) return 0;
    std::uint64_t lost = 0;
    for (std::size_t k = 0; k < hits.size(); ++k) {
        if (k + kPrefetchDistance < hits.size()) {
            const Entry& later = entries_[hits[k + kPrefetchDistance].surface];
            __builtin_prefetch(&later.hits, 1);
            __builtin_prefetch(&later.lasting[0], 1);
        }
        const SurfaceHit& hit = hits[k];
        Entry& entry = entries_[hit.surface];
        if (hit.impact) entry.hits.fetch_add(1, std::memory_order_relaxed);
        ImpulseSum& sum = hit.impact || hit.again ? entry.of_impacts : entry.lasting;
        const bool x = sum[0].add(hit.impulse.x, kImpulseUnit);
        const bool y = sum[1].add(hit.impulse.y, kImpulseUnit);
        const bool z = sum[2].add(hit.impulse.z, kImpulseUnit);
        lost += x && y && z ? 0 : 1;
    }
    return lost;
}

void SurfaceTotals::add(const SurfaceTotals& other) {
    for (std::size_t k = 0; k < entries_.size(); ++k) {
        entries_[k].hits.fetch_add(other.hits(k), std::memory_order_relaxed);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            add_words(entries_[k].of_impacts[axis], other.entries_[k].of_impacts[axis]);
            add_words(entries_[k].lasting[axis], other.entries_[k].lasting[axis]);
        }
    }
}

Vec3 SurfaceTotals::impulse(std::size_t surface) const {
    const Entry& entry = entries_[surface];
    Vec3 impulse;
    for (int axis = 0; axis < 3; ++axis) {
        FixedPointSum sum;
        add_words(sum, entry.of_impacts[static_cast<std::size_t>(axis)]);
        add_words(sum, entry.lasting[static_cast<std::size_t>(axis)]);
        impulse[axis] = sum.value(kImpulseUnit);
    }
    return impulse;
}

Vec3 SurfaceTotals::lasting_impulse(std::size_t surface) const {
    const auto& [x, y, z] = entries_[surface].lasting;
    return {x.value(kImpulseUnit), y.value(kImpulseUnit), z.value(kImpulseUnit)};
}

std::optional<Runaway> first_runaway(const std::vector<BlockRecord>& blocks) {
    std::optional<Runaway> first;
    for (const BlockRecord& block : blocks) {
        if (block.runaway && (!first || block.runaway->particle < first->particle)) first = block.runaway;
    }
    return first;
}

void RunRecorder::begin_step() {
    contacts_.clear();
    pair_records_.clear();
    last_violations_.clear();
}

void RunRecorder::record(const std::vector<BlockRecord>& blocks) {
    for (const BlockRecord& block : blocks) {
        add_part(statistics_, block.counts);
        generation_contacts_.insert(generation_contacts_.end(), block.contact_records.begin(),
                                    block.contact_records.end());
    }
    const std::vector<CutOff> cut_off = in_order_of_particles(blocks, &BlockRecord::cut_off);
    for (const CutOff& entry : cut_off) statistics_.unsimulated_time += entry.time;
    statistics_.budget_exhausted += cut_off.size();
    // Pinched particles do not count, because more bounces would not help them.
    for (const BlockRecord& block : blocks) statistics_.budget_exhausted -= block.counts.squeezed;
    const std::vector<Violation> found = in_order_of_particles(blocks, &BlockRecord::violations);
    const auto of_energy = static_cast<std::uint64_t>(std::ranges::count_if(
        found, [](const Violation& v) { return v.kind == ViolationKind::energy || v.kind == ViolationKind::rebound; }));
    statistics_.energy_violations += of_energy;
    statistics_.violations += found.size() - of_energy;
    list(found);
}

void add_load(std::vector<ColliderTotals>& totals, const ColliderLoad& load, const ColliderList& colliders) {
    ColliderTotals& of_collider = totals[colliders.collider_of(load.surface)];
    of_collider.hits += load.impact && load.is_hit ? 1 : 0;
    of_collider.impulse += load.impulse;
    of_collider.moment += load.moment;
    of_collider.work += load.work;
}

void RunRecorder::add_loads(std::span<const ColliderLoad> loads, const ColliderList& colliders) {
    for (const ColliderLoad& load : loads) add_load(loads_, load, colliders);
}

void RunRecorder::add_violations(const std::vector<Violation>& found) {
    statistics_.violations += found.size();
    list(found);
}

void RunRecorder::add_pair_violations(const std::vector<Violation>& found) {
    statistics_.pair_violations += found.size();
    list(found);
}

void RunRecorder::add_pair_impacts(const std::vector<PairImpactRecord>& impacts) {
    if (shows_contacts_) pair_records_.insert(pair_records_.end(), impacts.begin(), impacts.end());
}

void RunRecorder::list(const std::vector<Violation>& found) {
    last_violations_.insert(last_violations_.end(), found.begin(), found.end());
    const std::size_t kept = std::min(found.size(), Simulation::kMostViolations - violations_.size());
    violations_.insert(violations_.end(), found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept));
}

void RunRecorder::end_generation(std::size_t particles) {
    statistics_.particle_steps += particles;
    if (shows_contacts_) contacts_.insert(contacts_.end(), generation_contacts_.begin(), generation_contacts_.end());
}

// The sort is stable, because the impacts of one particle are already in the order of events.
void RunRecorder::put_in_order(std::vector<ContactRecord>& records) {
    std::ranges::stable_sort(records, [](const ContactRecord& a, const ContactRecord& b) {
        return a.time != b.time ? a.time < b.time : a.particle < b.particle;
    });
}

void RunRecorder::end_step() {
    put_in_order(contacts_);
    std::ranges::stable_sort(pair_records_, [](const PairImpactRecord& a, const PairImpactRecord& b) {
        return a.time != b.time ? a.time < b.time : a.first < b.first;
    });
}

namespace {

/// Particles per unit of parallel work.
constexpr std::size_t kBlock = 64;

VerifiedDeformation verified_deformation(const std::vector<Triangle>& triangles, const MeshMotion& motion) {
    VerifiedDeformation surface{triangles, {motion.times().begin(), motion.times().end()}, {}, false};
    surface.repeats = motion.ends() == MeshEnds::repeat;
    for (std::size_t key = 0; key < motion.key_count(); ++key) {
        surface.vertices.emplace_back(motion.positions(key).begin(), motion.positions(key).end());
    }
    return surface;
}

/// Returns the surfaces of all colliders for the verifier, each in its frame. A plane or a shape is one surface.
std::vector<VerifiedSurface> surfaces_of(const CollisionWorld& world, const MovingColliders& bodies) {
    std::vector<VerifiedSurface> surfaces(world.colliders().size());
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (bodies.deforming().is_mesh(i)) {
            const DeformingMesh& mesh = bodies.deforming().mesh(i);
            surfaces[i] = verified_deformation(mesh.triangles(), *mesh.motion());
            continue;
        }
        const CollisionWorld& own = bodies.world(bodies.body_of_collider(i));
        const ColliderShape& shape = own.colliders()[i].shape;
        if (const auto* ball = std::get_if<BallShape>(&shape)) {
            surfaces[i] = VerifiedShape{world_from_unit(*ball), false};
        } else if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
            surfaces[i] = VerifiedShape{world_from_unit(*cylinder), true};
        } else if (auto mesh = own.mesh_of(i)) {
            surfaces[i] = std::move(*mesh);
        }
        for (const auto& [plane, surface] : own.planes()) {
            if (own.name_of(surface).collider == i) surfaces[i] = VerifiedPlane{plane.point, plane.normal};
        }
    }
    return surfaces;
}

VerifiedMotion motion_of(const CollisionWorld& world, const MovingColliders& bodies) {
    VerifiedMotion motion;
    if (bodies.empty()) return motion;
    motion.frames = bodies.frames();
    for (const ColliderDescription& collider : world.colliders()) {
        motion.frame_of.push_back(collider.frame.empty() ? std::nullopt : motion.frames->find(collider.frame));
    }
    return motion;
}

}  // namespace

RunCheck::RunCheck(const CollisionWorld& world, const MovingColliders& bodies)
    : verifier_(surfaces_of(world, bodies), motion_of(world, bodies)) {}

void RunCheck::add_spawned(std::size_t particles) { watched_.resize(particles); }

void RunCheck::check(std::size_t i, const Particles& particles, const ForceInput& moved, const StepTimes& times,
                     std::span<const Segment> segments, std::vector<Violation>& violations,
                     const RecordedParts& motion) {
    const VerifiedStep step{
        particles.id[i], particles.position[i], moved.position, particles.radius[i], times.end, segments,
        motion,          times.stored};
    std::optional<VerifiedParticle>& watched = watched_[i];
    if (!watched) {
        watched = verifier_.watch(particles.position[i], particles.radius[i], std::max(0.0, particles.birth_time[i]));
    }
    verifier_.check(step, *watched, violations);
}

void RunCheck::check_rebounds(std::uint64_t particle, std::span<const RecordedImpact> impacts,
                              std::vector<Violation>& violations) {
    for (const RecordedImpact& impact : impacts) {
        if (!verify::has_wrong_rebound(impact)) continue;
        violations.push_back({ViolationKind::rebound, particle, impact.before.position, impact.time, {}, {}});
    }
}

std::vector<Violation> RunCheck::check_end(const Particles& particles, double time) const {
    std::vector<Violation> found;
    for (std::size_t i = 0; i < watched_.size(); ++i) {
        if (watched_[i]) verifier_.check_end(particles.id[i], time, *watched_[i], found);
    }
    return found;
}

std::vector<Violation> RunCheck::check_meetings(const std::vector<PairMeeting>& meetings,
                                                const verify::ImpactAudit& books) {
    std::vector<Violation> found;
    for (const PairMeeting& meeting : meetings) {
        if (!verify::is_wrong(meeting, books)) continue;
        const MetSphere& sphere = meeting.spheres.front();
        found.push_back({ViolationKind::pair_impact, sphere.particle, sphere.before.position, meeting.time, {}, {}});
    }
    return found;
}

std::vector<Violation> RunCheck::check_spheres(const Particles& particles, const TimeSpan& step, double most) {
    std::vector<StandingSphere> spheres;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (particles.radius[i] == 0.0 || particles.frozen[i] != 0) continue;
        const bool is_new = !has_looked_ || particles.birth_time[i] >= step.begin;
        spheres.push_back({particles.id[i], particles.position[i], particles.radius[i], is_new});
    }
    has_looked_ = true;
    std::vector<Violation> violations;
    for (const SphereOverlaps::Found& found : overlaps_.check(spheres, most)) {
        violations.push_back({ViolationKind::pair_overlap, found.first, found.position, step.end, {}, {}});
    }
    return violations;
}

void RunCheck::restart(const ParticleStore& store, double now) {
    const Particles& particles = store.particles();
    watched_.assign(particles.size(), std::nullopt);
    parallel_for(particles.size(), kBlock, [&](std::size_t i) {
        watched_[i] = verifier_.watch(particles.position[i], particles.radius[i], store.stored_time(i, now));
        watched_[i]->checked_until = now;
    });
}

void RunCheck::compact(const std::vector<std::uint8_t>& keep) { keep_marked(watched_, keep); }

}  // namespace ricochet
