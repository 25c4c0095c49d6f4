#include "ricochet/simulation/births.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "ricochet/core/algorithms.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"

namespace ricochet {
namespace {

/// Births in one block of parallel work. A block takes some hundred microseconds.
constexpr std::size_t kBirthBlock = 64;
/// Largest number of births that are taken off the schedule together. More need memory, fewer more communication.
constexpr std::uint64_t kMostInWave = std::uint64_t{1} << 20U;
/// Largest number of births in a wave that every rank makes, because this is faster than communicating refusals.
constexpr std::size_t kFewBirths = 16;

/// Largest number of time slices into which replay() divides the births, so that no list of births becomes long.
constexpr std::uint64_t kReplaySlices = 1000;

bool makes_spheres(const Emitter& emitter) {
    const DrawnValue& radius = emitter.description().radius;
    return radius.distribution || radius.mean + radius.spread > 0.0;
}

std::vector<Emitter> make_emitters(SimulationSetup& setup) {
    std::vector<Emitter> emitters;
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        emitters.emplace_back(std::move(setup.emitters[k]), setup.options.seed, static_cast<std::uint32_t>(k),
                              EmitterSurroundings{setup.options.frame_rate, setup.reference_camera, setup.attributes});
    }
    return emitters;
}

bool makes_spheres(const std::vector<Particle>& particles, const std::vector<Emitter>& emitters) {
    const auto is_sphere = [](const Particle& particle) { return particle.radius > 0.0; };
    return std::ranges::any_of(particles, is_sphere) ||
           std::ranges::any_of(emitters, [](const Emitter& emitter) { return makes_spheres(emitter); });
}

}  // namespace

StepBirths::StepBirths(std::span<Emitter> emitters, const BirthLimits& limits, const BirthTests& tests,
                       const RankShare& share)
    : emitters_(emitters), limits_(limits), tests_(tests), share_(share), made_of_(emitters.size(), 0) {}

bool StepBirths::make() {
    std::uint64_t born_before = 0;
    for (const Emitter& emitter : emitters_) born_before += emitter.born();
    for (Wave wave = next_wave(); !wave.empty(); wave = next_wave()) {
        make(wave);
        if (std::min(limits_.most_births, made_here_) > limits_.most_in_memory) return false;
        if (all_.empty()) {
            all_ = std::move(wave);
        } else {
            all_.insert(all_.end(), wave.begin(), wave.end());
        }
    }
    std::uint64_t born = 0;
    for (Emitter& emitter : emitters_) {
        emitter.skip_due(limits_.end);
        born += emitter.born();
    }
    give_ids();
    refused_by_population_ = born - born_before - refused_by_overlap_ - count_;
    return true;
}

// Takes at most as many births of each emitter as the population has room for, so that few births are made in vain. On
// a single rank, a wave ends with the first birth that does not fit into memory, so that make() reports it early.
StepBirths::Wave StepBirths::next_wave() {
    const bool may_end = share_.is_alone() && limits_.most_in_memory < limits_.most_births;
    const std::uint64_t most = may_end ? std::min(kMostInWave, limits_.most_in_memory + 1 - made_here_) : kMostInWave;
    Wave wave;
    for (std::uint32_t k = 0; k < emitters_.size() && wave.size() < most; ++k) {
        const std::uint64_t wanted = std::min(most - wave.size(), room_below(limits_.most_births, made_of_[k]));
        const std::vector<DueBirth> due = emitters_[k].take_due(limits_.end, wanted);
        grow_capacity_by(wave, due.size());
        for (const DueBirth& birth : due) wave.push_back({birth, k});
        if (tests_.among && !wave.empty()) break;
    }
    const auto by_time = [](const Entry& a, const Entry& b) { return a.due.time < b.due.time; };
    if (!std::ranges::is_sorted(wave, by_time)) std::ranges::stable_sort(wave, by_time);
    return wave;
}

bool StepBirths::may_be_refused(const Wave& wave) const {
    if (!tests_.alone && !tests_.among) return false;
    return std::ranges::any_of(wave, [this](const Entry& entry) { return makes_spheres(emitters_[entry.emitter]); });
}

void StepBirths::make(Wave& wave) {
    const bool may_be_refused = this->may_be_refused(wave);
    const bool shares_refusals = !share_.is_alone() && may_be_refused && wave.size() > kFewBirths;
    const bool all_make_all = may_be_refused && !shares_refusals;
    std::vector<std::size_t> mine;
    for (std::size_t k = 0; k < wave.size(); ++k) {
        if (all_make_all || share_.has_place_for(limits_.first_id + taken_ + k)) mine.push_back(k);
    }
    std::vector<std::optional<Particle>>& made = made_.emplace_back(mine.size());
    parallel_for(mine.size(), kBirthBlock, [&](std::size_t j) {
        const Entry& entry = wave[mine[j]];
        made[j] = emitters_[entry.emitter].make(entry.due, tests_.alone);
    });
    if (tests_.among) test_among(wave, mine, made);
    std::vector<std::uint64_t> refused;
    for (std::size_t j = 0; j < mine.size(); ++j) {
        if (!made[j]) refused.push_back(mine[j]);
    }
    keep_local(wave, mine, made);
    if (shares_refusals) refused = gather_list_to_all(share_.ranks(), refused);
    for (const std::uint64_t k : refused) wave[k].is_refused = true;
    refused_by_overlap_ += refused.size();
    taken_ += wave.size();
    std::erase_if(wave, [](const Entry& entry) { return entry.is_refused; });
    for (const Entry& entry : wave) ++made_of_[entry.emitter];
}

// Keeps this rank's accepted births until the step ends. Frees the memory if these are fewer than half.
void StepBirths::keep_local(Wave& wave, std::span<const std::size_t> mine, std::vector<std::optional<Particle>>& made) {
    std::vector<std::size_t> here;
    for (std::size_t j = 0; j < mine.size(); ++j) {
        if (!made[j] || !share_.has_place_for(limits_.first_id + taken_ + mine[j])) continue;
        if (here.size() < j) made[here.size()] = std::move(made[j]);
        here.push_back(mine[j]);
    }
    made.resize(here.size());
    if (here.size() < mine.size() / 2) made.shrink_to_fit();
    for (std::size_t j = 0; j < here.size(); ++j) wave[here[j]].made = &*made[j];
    made_here_ += here.size();
}

// Tests each birth against the births before it. A refused birth is made again from its first random draw, so it first
// draws the refused position again.
void StepBirths::test_among(const Wave& wave, std::span<const std::size_t> mine,
                            std::vector<std::optional<Particle>>& made) const {
    const BirthTest both = [this](const Particle& particle) {
        return (!tests_.alone || tests_.alone(particle)) && tests_.among(particle);
    };
    for (std::size_t j = 0; j < mine.size(); ++j) {
        const Entry& entry = wave[mine[j]];
        if (made[j] && !tests_.among(*made[j])) made[j] = emitters_[entry.emitter].make(entry.due, both);
    }
}

void StepBirths::give_ids() {
    const auto by_order = [](const Entry& a, const Entry& b) {
        return std::tuple(a.due.time, a.emitter, a.due.number) < std::tuple(b.due.time, b.emitter, b.due.number);
    };
    if (made_.size() > 1) std::ranges::sort(all_, by_order);
    count_ = std::min<std::uint64_t>(all_.size(), limits_.most_births);
    for (std::uint64_t k = 0; k < count_; ++k) {
        if (all_[k].made == nullptr) continue;
        all_[k].made->id = limits_.first_id + k;
        here_.push_back(all_[k].made);
    }
    all_ = Wave();  // frees memory for the particles
}

Emission::Emission(SimulationSetup& setup, Population& population, RankShare& share)
    : emitters_(make_emitters(setup)),
      has_spheres_(makes_spheres(setup.particles, emitters_)),
      population_(population),
      parts_(population.parts()),
      share_(share) {}

void Emission::add_first(std::vector<Particle>& first) {
    population_.reserve(first.size());
    std::vector<Particle*> added;
    for (Particle& particle : first) {
        particle.id = population_.store().next_id() + added.size();
        added.push_back(&particle);
    }
    population_.add(added);
}

void Emission::emit(const TimeSpan& step) {
    std::optional<SpawnOccupancy> occupancy;
    const BirthTests tests = tests_in(step, occupancy);
    const ParticleMemory& memory = population_.memory();
    const BirthLimits limits{step.end, room_below(parts_.options.most_particles, share_.living(population_.size())),
                             memory.room(population_.size()), population_.store().next_id()};
    StepBirths births(emitters_, limits, tests, share_);
    if (!births.make()) memory.refuse_to_grow(population_.size());
    if (share_.is_first()) {
        SimulationStatistics& statistics = parts_.recorder.statistics();
        statistics.births_refused_by_overlap += births.refused_by_overlap();
        statistics.births_refused_by_population += births.refused_by_population();
    }
    population_.reserve(births.here().size());
    population_.add(births.here());
    population_.store().set_next_id(limits.first_id + births.count());
    share_.add_births(births.count());
    if (births.count() > 0) population_.bind();
}

/// Returns the tests of births in a step. A new sphere must not overlap a surface, or another sphere if spheres
/// collide. A test is empty if there is nothing to overlap. The first test fills `occupancy` with the spheres present.
BirthTests Emission::tests_in(const TimeSpan& step, std::optional<SpawnOccupancy>& occupancy) const {
    BirthTests tests;
    const bool do_spheres_meet = parts_.options.particle_contacts.has_value();
    const ResponseRules& rules = parts_.response.rules();
    if (do_spheres_meet || rules.world.surface_count() > 0) {
        tests.alone = [this, &rules](const Particle& particle) {
            rules.poll();
            return !parts_.scene.overlap_of(particle);
        };
    }
    if (!do_spheres_meet) return tests;
    tests.among = [this, &rules, &occupancy, step](const Particle& particle) {
        if (!(particle.radius > 0.0) || !is_finite(particle.position)) return true;
        if (!occupancy) occupancy = occupancy_of(step);
        const ForceInput input{particle.position, particle.velocity, particle.mass, particle.radius,
                               particle.birth_time};
        const FlyingBall ball{particle.birth_time, particle.radius, particle.position, particle.velocity,
                              rules.forces.acceleration(input)};
        if (!occupancy->has_room(ball)) return false;
        occupancy->add(ball);
        return true;
    };
    return tests;
}

/// Returns the occupancy of the spheres present, which continue their motion from the start of the step.
SpawnOccupancy Emission::occupancy_of(const TimeSpan& step) const {
    SpawnOccupancy occupancy(step.end);
    const Particles& particles = population_.particles();
    const ForceField& forces = parts_.response.rules().forces;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double radius = particles.radius[i];
        if (!(radius > 0.0) || particles.frozen[i] != 0) continue;
        const bool stays = particles.pinned[i] != 0 || particles.resting[i] != 0;
        const Vec3 pull = stays ? Vec3{} : forces.acceleration(population_.store().force_input(i, step.begin));
        occupancy.add({step.begin, radius, particles.position[i], stays ? Vec3{} : particles.velocity[i], pull});
    }
    return occupancy;
}

// The slices do not change the births, because births do not depend on the division of time.
void Emission::replay(std::uint64_t steps, double time) {
    const std::uint64_t slices = std::min(steps, kReplaySlices);
    for (Emitter& emitter : emitters_) {
        double from = 0.0;
        for (std::uint64_t k = 1; k <= slices; ++k) {
            const double to = k == slices ? time : time * static_cast<double>(k) / static_cast<double>(slices);
            (void)emitter.births(from, to, 0);
            from = to;
        }
    }
}

}  // namespace ricochet
