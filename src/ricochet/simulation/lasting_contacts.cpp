#include "ricochet/simulation/lasting_contacts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/sleep_rules.h"

namespace ricochet {
namespace {

bool is_pinned(const ParticleStore& store, std::uint64_t particle) {
    const std::optional<std::size_t> i = store.index_of(particle);
    return i && store.is_fixed(*i);
}

/// Returns the gap between the spheres of a pair, divided by the smaller radius; infinite if one of them is gone.
double relative_gap(const ParticleStore& store, const ContactKey& key) {
    const std::optional<std::size_t> i = store.index_of(key.particle);
    const std::optional<std::size_t> k = store.index_of(key.other);
    if (!i || !k) return INFINITY;
    const Particles& p = store.particles();
    const double gap = length(p.position[*i] - p.position[*k]) - p.radius[*i] - p.radius[*k];
    return gap / std::min(p.radius[*i], p.radius[*k]);
}

}  // namespace

bool LastingContacts::is_sound(std::uint64_t next_id) const {
    const std::size_t surfaces = rules().world.surface_count();
    return memory_.is_sound(next_id, surfaces) && sleeping_islands_.is_sound(next_id, surfaces);
}

void LastingContacts::begin(const ParticleRange& range, const TimeSpan& step) {
    first_ = range.begin;
    are_children_ = range.are_children;
    wakings_ = 0;
    traces_.is_asleep.assign(range.size(), 0);
    if (are_children_ || sleeping_islands_.empty()) return;
    std::vector<std::uint64_t> gone;
    std::vector<std::uint64_t> carried;
    for (const std::uint64_t particle : sleeping_islands_.particles()) {
        const std::optional<std::size_t> i = parts_.store.index_of(particle);
        if (!i || parts_.store.is_fixed(*i)) {
            gone.push_back(particle);
            continue;
        }
        traces_.is_asleep[*i] = 1;
        parts_.schedule.leave_alone(*i);
        const Particles& particles = parts_.store.particles();
        if (is_beside_movers(rules(), particles.position[*i], particles.radius[*i])) carried.push_back(particle);
    }
    // Wakes the spheres on moving surfaces, because even a slow surface carries its spheres along.
    wake_alone(sleeping_islands_.islands_of_sleepers(carried), step.begin);
    wake(gone, step.begin);
}

/// Sleepers farther away wake later if they are pushed. Sleepers that have lost their support wake immediately.
void LastingContacts::wake(const std::vector<std::uint64_t>& particles, double time, int contacts) {
    if (particles.empty()) return;
    const int farther = std::max(0, ++wakings_ - kWakingsAlone);
    wake_alone(sleeping_islands_.around(particles, contacts << std::min(farther, kMostWakingDoublings)), time);
    std::vector<std::uint64_t> held;
    for (const WarmStartMemory::Entry& entry : sleeping_islands_.edge_contacts()) {
        const std::uint64_t sleeper = sleeper_of(entry.key);
        if (is_pinned(parts_.store, entry.key.particle + entry.key.other - sleeper)) held.push_back(sleeper);
    }
    for (const SleepingIslands::Weight& weight : sleeping_islands_.weights()) {
        const std::optional<std::size_t> i = parts_.store.index_of(weight.particle);
        if (!i) continue;
        const Vec3 pull = rules().forces.acceleration(parts_.store.force_input(*i, time));
        if (holds(rules(), weight.surface, -weight.force, pull)) held.push_back(weight.particle);
    }
    wake_alone(sleeping_islands_.not_joined_to(held), time);
}

void LastingContacts::wake_alone(const std::vector<std::uint64_t>& woken, double time) {
    if (woken.empty()) return;
    for (const std::uint64_t particle : woken) {
        const std::optional<std::size_t> i = parts_.store.index_of(particle);
        if (!i) continue;
        parts_.mover.wake(*i, time);
        if (*i >= first_ && *i - first_ < traces_.is_asleep.size()) traces_.is_asleep[*i - first_] = 0;
    }
    std::vector<WarmStartMemory::Entry> contacts = sleeping_islands_.wake(woken);
    // Keeps only contacts with an impulse that the memory lacks, because the others of awake spheres are known or
    // ended.
    const auto has_slept = [&](std::uint64_t particle) {
        return std::ranges::binary_search(woken, particle) || sleeping_islands_.is_asleep(particle) ||
               is_pinned(parts_.store, particle);
    };
    std::erase_if(contacts, [&](const WarmStartMemory::Entry& entry) {
        const ContactKey& key = entry.key;
        const bool goes_on = memory_.find(key) != nullptr;
        return goes_on || entry.impulse.normal == 0.0 || !has_slept(key.particle) ||
               !(key.is_wall() || has_slept(key.other));
    });
    memory_.add(contacts);
}

void LastingContacts::wake_all(double time) { wake_alone(sleeping_islands_.particles(), time); }

/// Calls mark(i) for the particles in contacts of the last step's contact islands, with their indices.
template <class Mark>
void LastingContacts::mark_contacts(bool with_rebounds, const Mark& mark) const {
    const auto find_and_mark = [&](std::uint64_t particle) {
        if (const std::optional<std::size_t> i = parts_.store.index_of(particle)) mark(*i);
    };
    for (const WarmStartMemory::Entry& entry : memory_.entries()) {
        if (entry.rebounds && !with_rebounds) continue;
        find_and_mark(entry.key.particle);
        if (!entry.key.is_wall()) find_and_mark(entry.key.other);
    }
}

const PairTraces& LastingContacts::find_traces() {
    const std::size_t size = traces_.is_asleep.size();
    traces_.version = sleeping_islands_.version();
    traces_.presses.assign(size, 0);
    mark_contacts(true, [&](std::size_t i) {
        if (i >= first_ && i - first_ < size) traces_.presses[i - first_] = 1;
    });
    return traces_;
}

std::vector<std::uint8_t> LastingContacts::pressing() const {
    std::vector<std::uint8_t> pressing(parts_.store.size(), 0);
    mark_contacts(false, [&](std::size_t i) { pressing[i] = 1; });
    return pressing;
}

/// Returns true if a sphere hits a sleeper in the step. A slow sphere that only presses the sleeper onto its supports
/// does not count, because the impulse of the contact shows this load. hitting, sleeping: particle indices.
bool LastingContacts::hits_sleeper(std::size_t hitting, std::size_t sleeping, const TimeSpan& step) const {
    const Particles& particles = parts_.store.particles();
    const double duration = step.end - step.begin;
    ForceInput state = parts_.store.force_input(hitting, step.begin);
    const double pull = length(rules().forces.acceleration(state));
    state.coupling = parts_.coupled.coupling_of(hitting);
    const double gained = duration * length(rules().forces.acceleration(state));
    const Vec3& velocity = particles.velocity[hitting];
    const Vec3 towards = particles.position[sleeping] - particles.position[hitting];
    const double gap = length(towards) - particles.radius[hitting] - particles.radius[sleeping];
    if (gap > duration * (length(velocity) + gained)) return false;  // the spheres do not meet in this step
    const double resting = rules().settings.resting_speed;
    const double slow = std::max(resting, std::sqrt(2.0 * pull * kWakingFall * particles.radius[hitting]));
    if (length(velocity) > slow) return true;
    return is_opposed_by_friction(sleeping, towards, step.begin) && dot(velocity, towards) > resting * length(towards);
}

/// Returns true if only friction opposes a push on a sleeper, because its direction is not onto the supports.
bool LastingContacts::is_opposed_by_friction(std::size_t sleeping, const Vec3& direction, double time) const {
    const Vec3 pull = rules().forces.acceleration(parts_.store.force_input(sleeping, time));
    return pull == Vec3{} || dot(direction, pull) < kOntoSupports * length(direction) * length(pull);
}

bool LastingContacts::wake_hit_sleepers(const PairPlans& plans, const TimeSpan& step) {
    if (sleeping_islands_.empty() || are_children_) return false;
    std::vector<std::uint64_t> hit;
    double largest = 1.0;  // largest ratio of a sphere's radius to that of the sleeper that it hits
    for (std::size_t n = 0; n < plans.pairs().size(); ++n) {
        const NeighbourPair& pair = plans.pairs()[n];
        if (!plans.may_meet(n) || is_asleep(pair.first) == is_asleep(pair.second)) continue;
        const std::uint32_t sleeping = is_asleep(pair.first) ? pair.first : pair.second;
        const std::uint32_t hitting = is_asleep(pair.first) ? pair.second : pair.first;
        if (!hits_sleeper(first_ + hitting, first_ + sleeping, step)) continue;
        const Particles& particles = parts_.store.particles();
        hit.push_back(particles.id[first_ + sleeping]);
        largest = std::max(largest, particles.radius[first_ + hitting] / particles.radius[first_ + sleeping]);
    }
    // All small spheres that a large sphere covers are woken at once, because each call repeats the whole solution.
    wake(hit, step.begin, static_cast<int>(std::min(largest, kMostWokenContacts)));
    return !hit.empty();
}

std::vector<std::uint64_t> LastingContacts::loaded_sleepers(std::span<const PairImpactRecord> impacts,
                                                            const ContactIslandTrace& trace,
                                                            const TimeSpan& step) const {
    std::vector<std::uint64_t> loaded;
    if (sleeping_islands_.empty() || are_children_) return loaded;
    for (const PairImpactRecord& impact : impacts) {
        if (sleeping_islands_.is_asleep(impact.first) == sleeping_islands_.is_asleep(impact.second)) continue;
        if (impact.approach > rules().settings.resting_speed)
            loaded.push_back(sleeping_islands_.is_asleep(impact.first) ? impact.first : impact.second);
    }
    for (const WarmStartMemory::Entry& entry : trace.pressed) {
        if (is_pressed_more(entry, step)) loaded.push_back(sleeper_of(entry.key));
    }
    return loaded;
}

void LastingContacts::plan_sleep(std::span<const ContactIslandMember> members, ContactIsland& island,
                                 const TimeSpan& step, ContactIslandTrace& trace) const {
    if (are_children_ || !rules().forces.is_steady()) return;
    const bool beside_movers = std::ranges::any_of(members, [&](const ContactIslandMember& member) {
        return is_beside_movers(rules(), member.moving->state.position, member.radius);
    });
    std::vector<std::uint8_t> sleepy(members.size(), 0);
    bool is_any_sleepy = false;
    for (std::size_t i = 0; i < members.size(); ++i) {
        sleepy[i] = members[i].is_fixed ? 1 : 0;
        if (!is_slow(members[i], island.planned(i), beside_movers) || !may_sleep(rules(), members[i], step)) continue;
        const double pull = length(rules().forces.acceleration(members[i].moving->state));
        if (!is_at_rest(members[i], island.planned(i), pull)) continue;
        const std::uint64_t id = members[i].moving->id;
        const std::uint32_t enough = steps_to_sleep(members[i], pull);
        const std::uint32_t steps = std::min(sleeping_islands_.sleep_counter(id) + 1, enough);
        trace.still.push_back({id, steps});
        sleepy[i] = steps == enough && !is_carried_by_material(rules(), island, i) ? 1 : 0;
        is_any_sleepy = is_any_sleepy || sleepy[i] != 0;
    }
    if (!is_any_sleepy) return;
    const std::vector<NeighbourPair> pressing = island.pressing();
    std::vector<std::uint8_t> falls = sleepy;
    for (const auto& [a, b] : pressing) {
        if (sleepy[a] == 0) falls[b] = 0;
        if (sleepy[b] == 0) falls[a] = 0;
    }
    std::vector<std::uint8_t> is_held(members.size(), 0);
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (falls[i] != 0)
            is_held[i] = members[i].is_fixed || is_supported_by_surfaces(rules(), members[i], island, i) ? 1 : 0;
    }
    keep_supported(falls, is_held, pressing);
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (falls[i] == 0 || members[i].is_fixed) continue;
        const std::uint64_t id = members[i].moving->id;
        trace.stopped.push_back({id, members[i].moving->state.mass * island.planned(i).velocity});
        island.put_to_rest(i);
        trace.falling_asleep.push_back(id);
        for (const WallImpulse& wall_impulse : island.impulses_of(i)) {
            const double mass = members[i].moving->state.mass;
            trace.weights.push_back(
                {id, wall_impulse.surface, -(mass / members[i].duration) * wall_impulse.velocity_change});
        }
    }
    std::ranges::sort(trace.falling_asleep);
}

void LastingContacts::end(std::span<const ContactIslandTrace* const> traces, std::span<const PairImpactRecord> impacts,
                          const TimeSpan& step) {
    if (are_children_) return memory_.add(joined(traces, &ContactIslandTrace::pressed));
    loads_.pass_on(impulses_on_sleepers(traces, impacts), step);
    std::vector<const std::vector<WarmStartMemory::Entry>*> pressed;
    for (const ContactIslandTrace* const trace : traces) pressed.push_back(&trace->pressed);
    memory_.replace(pressed);
    put_to_sleep(traces, step);
    loads_.stop(joined(traces, &ContactIslandTrace::stopped), step);
}

std::vector<SleeperImpulse> LastingContacts::impulses_on_sleepers(std::span<const ContactIslandTrace* const> traces,
                                                                  std::span<const PairImpactRecord> impacts) const {
    if (sleeping_islands_.empty()) return {};
    std::vector<SleeperImpulse> impulses = joined(traces, &ContactIslandTrace::onto_sleepers);
    for (const PairImpactRecord& impact : impacts) {
        if (sleeping_islands_.is_asleep(impact.first)) impulses.push_back({impact.first, -impact.impulse});
        if (sleeping_islands_.is_asleep(impact.second)) impulses.push_back({impact.second, impact.impulse});
    }
    return impulses;
}

void LastingContacts::put_to_sleep(std::span<const ContactIslandTrace* const> traces, const TimeSpan& step) {
    sleeping_islands_.set_sleep_counters(joined(traces, &ContactIslandTrace::still));
    wake_unsupported(step);
    const std::vector<std::uint64_t> falling = joined(traces, &ContactIslandTrace::falling_asleep);
    if (falling.empty()) return;
    std::vector<WarmStartMemory::Entry> contacts;
    for (const ContactIslandTrace* const trace : traces) {
        const std::vector<std::uint64_t>& own = trace->falling_asleep;
        if (own.empty()) continue;
        const auto falls = [&](std::uint64_t id) { return std::ranges::binary_search(own, id); };
        std::copy_if(trace->pressed.begin(), trace->pressed.end(), std::back_inserter(contacts),
                     [&](const WarmStartMemory::Entry& entry) {
                         return falls(entry.key.particle) || (!entry.key.is_wall() && falls(entry.key.other));
                     });
    }
    // Adds all spheres in one call, because each call visits all sleepers.
    sleeping_islands_.add(falling, contacts, joined(traces, &ContactIslandTrace::weights));
    sleeping_islands_.join(joined(traces, &ContactIslandTrace::touching));
}

/// Does nothing without moving colliders, because only among them the verifier follows the time of every particle.
void LastingContacts::check_sleepers(const TimeSpan& step, std::vector<BlockRecord>& blocks) const {
    if (sleeping_islands_.empty() || are_children_ || rules().bodies.empty()) return;
    BlockRecord& record = blocks.emplace_back();
    for (std::size_t k = 0; k < traces_.is_asleep.size(); ++k) {
        if (is_asleep(static_cast<std::uint32_t>(k))) parts_.mover.report_sleeper(k, step, record);
    }
}

std::uint64_t LastingContacts::sleeper_of(const ContactKey& key) const {
    return sleeping_islands_.is_asleep(key.particle) ? key.particle : key.other;
}

bool LastingContacts::is_at_edge_of_sleep(const ContactKey& key) const {
    return !key.is_wall() && sleeping_islands_.is_asleep(key.particle) != sleeping_islands_.is_asleep(key.other);
}

bool LastingContacts::is_pressed_more(const WarmStartMemory::Entry& entry, const TimeSpan& step) const {
    if (!is_at_edge_of_sleep(entry.key)) return false;
    const std::uint64_t sleeper = sleeper_of(entry.key);
    const std::optional<std::size_t> i = parts_.store.index_of(sleeper);
    const std::optional<std::size_t> other = parts_.store.index_of(entry.key.particle + entry.key.other - sleeper);
    if (!i || !other) return false;
    const ForceInput state = parts_.store.force_input(*i, step.begin);
    const double pull = length(rules().forces.acceleration(state));
    const std::vector<Vec3>& position = parts_.store.particles().position;
    const bool goes_aside = is_opposed_by_friction(*i, position[*i] - position[*other], step.begin);
    const double weights =
        (goes_aside ? kWakingWeightsAside : kWakingWeights) * state.mass * pull * (step.end - step.begin);
    return entry.impulse.normal > kMorePressed * (sleeping_islands_.load_of(sleeper) + weights);
}

/// Wakes sleepers that a touching sphere has left, and sleepers that another sphere overlaps.
void LastingContacts::wake_unsupported(const TimeSpan& step) {
    if (sleeping_islands_.empty()) return;
    std::vector<std::uint64_t> left;
    for (const WarmStartMemory::Entry& entry : sleeping_islands_.edge_contacts()) {
        if (relative_gap(parts_.store, entry.key) > kWakingFall) left.push_back(sleeper_of(entry.key));
    }
    for (const WarmStartMemory::Entry& entry : memory_.entries()) {
        if (is_at_edge_of_sleep(entry.key) && relative_gap(parts_.store, entry.key) < -kWakingOverlap)
            left.push_back(sleeper_of(entry.key));
    }
    wake(left, step.end);
}

}  // namespace ricochet
