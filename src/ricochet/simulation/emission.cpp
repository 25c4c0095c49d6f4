#include "ricochet/simulation/emission.h"

#include <algorithm>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/simulation.h"

namespace ricochet {
namespace {

/// Number of slices of time in which emitters repeat their births, so that no list of births becomes long.
constexpr std::uint64_t kReplaySlices = 1000;

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
    return std::any_of(particles.begin(), particles.end(), is_sphere) ||
           std::any_of(emitters.begin(), emitters.end(), [](const Emitter& emitter) {
               const MeanSpread& radius = emitter.description().radius;
               return radius.mean > 0.0 || radius.spread > 0.0;
           });
}

}  // namespace

Emission::Emission(SimulationSetup& setup, Population& population, const PopulationParts& parts, RankShare& share)
    : emitters_(make_emitters(setup)),
      has_spheres_(makes_spheres(setup.particles, emitters_)),
      population_(population),
      parts_(parts),
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

/// Returns the tests of births in a step: a sphere must overlap no surface, and no other sphere that it can meet. A
/// test is empty if nothing can be overlapped. occupancy: filled with the spheres present by the first birth.
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

// Births do not depend on the division of time.
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
