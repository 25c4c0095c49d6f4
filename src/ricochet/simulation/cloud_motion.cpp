#include "ricochet/simulation/cloud_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/algorithms.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/run_recorder.h"

namespace ricochet {
namespace {

/// Returns the response that moves a child after a bounce, for the rest of a piece. Its integrator is of fourth order
/// for every integrator of the run, because children circle the parent or oscillate about it.
std::unique_ptr<Response> response_of_clouds(const ResponseRules& rules) {
    ResponseRules own = rules;
    own.settings.integrator = IntegratorKind::rk4;
    own.look_ahead = false;
    return make_response(ResponseKind::exact, own);
}

}  // namespace

/// Progress of a child through a step.
struct CloudMotion::Journey {
    std::size_t particle = 0;
    double now = 0.0;    ///< s
    double until = 0.0;  ///< end of the child's life in the step, in s
    Track* track = nullptr;
};

CloudMotion::CloudMotion(const std::vector<Emitter>& emitters, ParticleStore& store, ActiveMover& mover,
                         const Retirement& retirement)
    : emitters_(emitters),
      store_(store),
      retirement_(retirement),
      free_mover_(mover),
      response_(response_of_clouds(mover.response().rules())),
      mover_(mover.with(*response_)),
      has_children_(emitters.size(), 0) {
    for (const Emitter& emitter : emitters) {
        const auto& parent = emitter.description().parent;
        if (!is_cloud(emitter.description())) continue;
        has_children_[parent->emitter] = 1;
        if (parent->recursive) has_children_[emitter.number()] = 1;
    }
}

std::span<const FlightKnot> CloudMotion::knots_of(std::uint64_t id) const {
    const auto found = tracks_.find(id);
    return found == tracks_.end() ? std::span<const FlightKnot>() : found->second.knots;
}

std::vector<std::int64_t> CloudMotion::parents() const {
    std::vector<std::int64_t> parents;
    for (const Member& member : members_) {
        parents.push_back(member.parent == kNobody ? -1 : static_cast<std::int64_t>(member.parent));
    }
    return parents;
}

const CloudRule& CloudMotion::rule_of(std::size_t i) const {
    return *emitters_[store_.particles().origin[i].emitter].description().parent->cloud;
}

bool CloudMotion::is_parent(std::size_t i) const {
    const std::uint32_t emitter = store_.particles().origin[i].emitter;
    return emitter != kNoEmitter && has_children_[emitter] != 0;
}

const char* CloudMotion::fault_of(std::size_t i) const {
    if (!has_parent(i)) return nullptr;
    const std::uint32_t emitter = store_.particles().origin[i].emitter;
    const bool is_sound = emitter < emitters_.size() && is_cloud(emitters_[emitter].description()) &&
                          members_[i].parent < store_.next_id() && is_finite(members_[i].offset);
    return is_sound ? nullptr : "a particle of an unknown cloud";
}

void CloudMotion::compact(const std::vector<std::uint8_t>& keep) { keep_marked(members_, keep); }

void CloudMotion::before_generation(const ParticleRange& generation, const TimeSpan& /*step*/) {
    const Particles& particles = store_.particles();
    starts_.resize(generation.size());
    for (std::size_t i = generation.begin; i < generation.end; ++i) {
        if (is_parent(i)) starts_[i - generation.begin] = {particles.position[i], particles.velocity[i]};
    }
}

/// Records the paths of parents that are not in a cloud themselves.
void CloudMotion::note_tracks(const ParticleRange& generation, const TimeSpan& step,
                              const std::vector<BlockRecord>& blocks) {
    const RecordsByParticle records(joined(blocks, &BlockRecord::contact_records));
    const Particles& particles = store_.particles();
    for (std::size_t i = generation.begin; i < generation.end; ++i) {
        if (!is_parent(i) || has_parent(i)) continue;
        const std::uint64_t id = particles.id[i];
        tracks_[id] = {flight_knots(particles, i, starts_[i - generation.begin], step.begin, step.end, records.of(id)),
                       has_ended(particles, i, step.end)};
    }
}

/// Returns the cloud particles of the generation, grouped by their depth below a parent that is not in a cloud.
std::vector<std::vector<std::size_t>> CloudMotion::levels_of(const ParticleRange& generation) const {
    std::vector<std::size_t> all;
    for (std::size_t i = generation.begin; i < generation.end; ++i) {
        if (has_parent(i) && !store_.is_fixed(i)) all.push_back(i);
    }
    const auto depth = [&](std::size_t i) { return store_.particles().origin[i].generation; };
    std::ranges::stable_sort(all, {}, depth);
    std::vector<std::vector<std::size_t>> levels;
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (k == 0 || depth(all[k]) != depth(all[k - 1])) levels.emplace_back();
        levels.back().push_back(all[k]);
    }
    return levels;
}

void CloudMotion::after_substep(const ParticleRange& generation, const TimeSpan& step,
                                std::vector<BlockRecord>& blocks) {
    note_tracks(generation, step, blocks);
    for (const std::vector<std::size_t>& level : levels_of(generation)) {
        const std::size_t first = blocks.size();
        blocks.resize(first + blocks_of(level.size()));
        std::vector<Track> tracks(level.size());
        parallel_for_blocks(level.size(), kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
            MoveScratch scratch;
            mover_.prepare(scratch);
            for (std::size_t k = begin; k < end; ++k) {
                move_child(level[k], step, scratch, blocks[first + block], tracks[k]);
            }
            mover_.record_lists(scratch, blocks[first + block]);
        });
        for (std::size_t k = 0; k < level.size(); ++k) {
            if (is_parent(level[k])) tracks_[store_.particles().id[level[k]]] = std::move(tracks[k]);
        }
    }
}

/// Moves a child to the end of its life in the step. track: filled with the child's path if the child has children.
void CloudMotion::move_child(std::size_t i, const TimeSpan& step, MoveScratch& scratch, BlockRecord& record,
                             Track& track) {
    Particles& particles = store_.particles();
    const double death = particles.birth_time[i] + particles.lifetime[i];
    Journey journey{i, std::max(step.begin, particles.birth_time[i]), std::min(step.end, death)};
    if (is_parent(i)) {
        journey.track = &track;
        track.add(journey.now, particles, i);
    }
    const auto parent = tracks_.find(members_[i].parent);
    const bool is_alone = parent == tracks_.end() || follow(journey, parent->second, scratch, record);
    if (is_alone && particles.absorbed[i] == 0) {
        part(i, journey.now);
        const std::size_t first = scratch.records.size();
        if (journey.now < journey.until && !has_parent(i) && !store_.is_fixed(i) &&
            !has_ended(particles, i, journey.now)) {
            free_mover_.move_one(i, {journey.now, journey.until}, scratch, record);
            journey.now = journey.until;
        }
        if (journey.track != nullptr) add_impacts(track.knots, std::span(scratch.records).subspan(first));
    }
    if (journey.track == nullptr) return;
    track.ends = has_ended(particles, i, step.end);
    if (particles.absorbed[i] == 0) track.add(journey.now, particles, i);
}

/// Moves the child along its parent's path. Returns true if the parent's life has ended, and the child is alone.
bool CloudMotion::follow(Journey& journey, const Track& parent, MoveScratch& scratch, BlockRecord& record) {
    const std::vector<FlightKnot>& knots = parent.knots;
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
        const FlightKnot& from = knots[k];
        const FlightKnot& to = knots[k + 1];
        if (to.time < journey.now) continue;
        if (!fly_along(journey, from, to, scratch, record)) return false;
        const bool is_last = k + 2 == knots.size();  // a parent that ends at an impact does not pass the impact on
        if (!(is_last && parent.ends)) add_forces(journey, from, to, scratch);
    }
    return parent.ends && journey.now >= knots.back().time;
}

CloudMember CloudMotion::member_of(std::size_t i, const FlightKnot& from, const FlightKnot& to) const {
    const double duration = to.time - from.time;
    const Path path = duration > 0.0 ? hermite_path(from.position, from.after, to.position, to.before, duration)
                                     : line_path(from.position, from.after, 0.0);
    return {rule_of(i), path, from.time, members_[i].offset, store_.particles().birth_time[i]};
}

/// Moves the child along one flight of the parent. The flight ends at an impact or with the step. Returns false if the
/// child becomes fixed, or its life in the step ends, before the flight ends.
bool CloudMotion::fly_along(Journey& journey, const FlightKnot& from, const FlightKnot& to, MoveScratch& scratch,
                            BlockRecord& record) {
    const std::size_t i = journey.particle;
    const CloudMember member = member_of(i, from, to);
    const double begin = journey.now;
    const double end = std::min(to.time, journey.until);
    const double turn = cloud_turn(rule_of(i), std::max(0.0, end - begin));
    const auto pieces = static_cast<int>(std::max(1.0, std::ceil(turn / kMostCloudTurn)));
    for (int k = 1; k <= pieces && begin < end; ++k) {
        fly_piece(journey, member, k == pieces ? end : begin + (end - begin) * k / pieces, scratch, record);
        if (store_.is_fixed(i)) return false;
    }
    return end == to.time;
}

/// Adds the velocity change of the parent's impact at the end of a flight to the child's velocity.
void CloudMotion::add_forces(Journey& journey, const FlightKnot& from, const FlightKnot& to, MoveScratch& scratch) {
    const std::size_t i = journey.particle;
    Particles& particles = store_.particles();
    const Vec3 change = to.after - to.before;
    if (change == Vec3{} || !(particles.birth_time[i] < to.time)) return;
    const Vec3 before = particles.velocity[i];
    if (particles.support[i][0] == kNoSupport) {
        particles.velocity[i] += change;
    } else {
        const double held_for = to.time > from.time ? to.time - from.time : response_->rules().settings.time_step;
        const CloudMember member = member_of(i, from, to);
        mover_.apply_velocity_change(i, change, to.time, held_for, &member, scratch);
    }
    if (journey.track == nullptr) return;
    journey.track->knots.push_back({to.time, particles.position[i], before, particles.velocity[i]});
}

void CloudMotion::fly_piece(Journey& journey, const CloudMember& member, double until, MoveScratch& scratch,
                            BlockRecord& record) {
    const std::size_t i = journey.particle;
    const Particles& particles = store_.particles();
    const double begin = journey.now;
    const PhaseState now{particles.position[i], particles.velocity[i]};
    const PhaseState then = member.after(now, begin, until);
    ForceInput start = store_.force_input(i, begin);
    start.coupling = &member;
    const Path path = hermite_path(now.position, now.velocity, then.position, then.velocity, until - begin);
    const Flight plan{path, 2.0 * path.c[2], 0.0, start, then.velocity};
    const std::size_t first = scratch.records.size();
    const ActiveMover::Lead lead{plan, member};
    mover_.move_one(i, {begin, until}, scratch, record, &lead);
    journey.now = until;
    if (journey.track == nullptr) return;
    add_impacts(journey.track->knots, std::span(scratch.records).subspan(first));
    if (particles.absorbed[i] == 0) journey.track->add(until, particles, i);
}

/// Releases particle i from its cloud at a time, in s.
void CloudMotion::part(std::size_t i, double time) {
    Particles& particles = store_.particles();
    const CloudEnd end = rule_of(i).end;
    members_[i] = {};
    if (end != CloudEnd::die) return;
    double& lifetime = particles.lifetime[i];
    const double birth = particles.birth_time[i];
    lifetime = std::min(lifetime, std::max(0.0, time - birth));
    while (lifetime > 0.0 && birth + lifetime > time) lifetime = std::nextafter(lifetime, 0.0);
}

void CloudMotion::retire(double time) {
    if (!retirement_.has_bounds()) return;
    std::unordered_map<std::uint64_t, std::size_t> parents;
    for (std::size_t i = 0; i < store_.size(); ++i) {
        if (is_parent(i)) parents[store_.particles().id[i]] = i;
    }
    for (const std::vector<std::size_t>& level : levels_of({0, store_.size()})) {
        for (const std::size_t i : level) {
            const auto parent = parents.find(members_[i].parent);
            const bool stays = parent != parents.end() && retirement_.removal_reason(parent->second, time) == nullptr;
            if (!stays) part(i, time);
        }
    }
}

}  // namespace ricochet
