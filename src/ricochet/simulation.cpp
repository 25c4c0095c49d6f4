#include "ricochet/simulation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/collision/collision_world.h"
#include "ricochet/core/error.h"
#include "ricochet/core/fixed_point_sum.h"
#include "ricochet/core/hash.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates.h"
#include "ricochet/response/exact.h"

namespace ricochet {
namespace {

/// Particles per unit of parallel work.
constexpr std::size_t kBlock = 256;

/// A final step shorter than this fraction of a step is not made: duration / time_step is meant to be whole.
constexpr double kStepRounding = 1e-6;

std::uint64_t count_steps(const SimulationOptions& options) {
    return static_cast<std::uint64_t>(std::max(0.0, std::ceil(options.duration / options.time_step - kStepRounding)));
}

SimulationOptions checked(const SimulationOptions& options) {
    if (!(options.time_step > 0.0) || !std::isfinite(options.time_step)) {
        throw InputError("time_step must be a finite number above 0 s");
    }
    if (!(options.duration >= 0.0) || !std::isfinite(options.duration)) {
        throw InputError("duration must be a finite number of at least 0 s");
    }
    if (options.duration / options.time_step > 1e15) throw InputError("duration / time_step exceeds 1e15 steps");
    if (!(options.resting_speed >= 0.0)) throw InputError("resting_speed must be at least 0 m/s");
    if (options.bounce_budget == 0) throw InputError("bounce_budget must be at least 1");
    return options;
}

/// Totals of one surface.
struct SurfaceTotals {
    std::atomic<std::uint64_t> hits{0};
    FixedPointSum x;
    FixedPointSum y;
    FixedPointSum z;
};

/// What a block of particles adds to the statistics; blocks are added in order.
struct BlockCounts {
    std::uint64_t contacts = 0;
    std::uint64_t budget_exhausted = 0;
    std::uint64_t stayed = 0;
    std::uint64_t frozen = 0;
    std::uint64_t lost_impulses = 0;
    std::uint32_t bounces_max = 0;
    double unsimulated = 0.0;
    std::vector<ContactRecord> records;

    void add(const MoveOutcome& outcome) {
        contacts += outcome.bounces;
        stayed += outcome.stayed;
        frozen += outcome.frozen ? 1 : 0;
        budget_exhausted += outcome.unsimulated_time > 0.0 ? 1 : 0;
        unsimulated += outcome.unsimulated_time;
        bounces_max = std::max(bounces_max, outcome.bounces);
    }
};

}  // namespace

struct Simulation::Impl {
    explicit Impl(SimulationSetup setup);

    void emit(double from, double to);
    void add(Particle particle);
    void move_all(double from, double to);
    void move_block(std::size_t begin, std::size_t end, double from, double to, BlockCounts& counts);
    void add_hits(const std::vector<SurfaceHit>& hits, BlockCounts& counts);
    void collect_records(std::vector<BlockCounts>& blocks);
    [[nodiscard]] bool stays_at_rest(std::size_t i, double now) const;
    void store(std::size_t i, const MovingParticle& moving, const MoveOutcome& outcome);
    void retire(double now);
    [[nodiscard]] bool starts_in_overlap(const Particle& particle) const;
    [[nodiscard]] double time_at(std::uint64_t step) const {
        return step >= steps ? options.duration : static_cast<double>(step) * options.time_step;
    }
    [[nodiscard]] ForceInput input(std::size_t i, double now) const {
        return {particles.position[i], particles.velocity[i], particles.mass[i], particles.radius[i], now};
    }

    SimulationOptions options;
    ForceField forces;
    std::vector<Material> materials;
    CollisionWorld world;
    std::vector<Emitter> emitters;
    std::optional<Box3> bounds;
    ExactResponse response;
    Particles particles;
    SimulationStatistics statistics;
    std::vector<SurfaceTotals> totals;
    std::vector<ContactRecord> records;
    std::uint64_t steps;
    std::uint64_t next_id = 0;
};

Simulation::Impl::Impl(SimulationSetup setup)
    : options(checked(setup.options)),
      forces(std::move(setup.forces)),
      materials(std::move(setup.materials)),
      world(std::move(setup.colliders)),
      bounds(setup.bounds),
      response(world, forces, materials,
               {options.integrator, options.resting_speed, options.bounce_budget, options.seed}),
      totals(options.triangle_totals ? world.surface_count() : 0),
      steps(count_steps(options)) {
    for (const ColliderDescription& collider : world.colliders()) {
        if (collider.material >= materials.size())
            throw InputError("collider \"" + collider.name + "\" has no material");
    }
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        emitters.emplace_back(std::move(setup.emitters[k]), options.seed, static_cast<std::uint32_t>(k));
    }
    for (const Particle& particle : setup.particles) add(particle);
}

void Simulation::Impl::add(Particle particle) {
    particle.id = next_id++;
    particle.position = flush_tiny(particle.position);
    world.prepare_radius(particle.radius);
    if (starts_in_overlap(particle)) ++statistics.started_inside;
    particles.append(particle);
    ++statistics.emitted;
}

bool Simulation::Impl::starts_in_overlap(const Particle& particle) const {
    if (!is_finite(particle.position) || max_abs(particle.position) > kLargestCoordinate) return false;
    ContactScratch scratch;
    ContactSearch search(world, scratch);
    (void)search.search(line_path(particle.position, Vec3{}, 0.0), particle.radius);
    return search.starts_in_overlap();
}

// Births of all emitters are merged by (birth time, emitter), which fixes the ids for any time step.
void Simulation::Impl::emit(double from, double to) {
    std::vector<Particle> born;
    for (Emitter& emitter : emitters) {
        const std::vector<Particle> births = emitter.births(from, to);
        born.insert(born.end(), births.begin(), births.end());
    }
    std::stable_sort(born.begin(), born.end(),
                     [](const Particle& a, const Particle& b) { return a.birth_time < b.birth_time; });
    for (const Particle& particle : born) add(particle);
}

void Simulation::Impl::move_all(double from, double to) {
    const std::size_t count = particles.size();
    std::vector<BlockCounts> blocks((count + kBlock - 1) / kBlock);
    parallel_for_blocks(count, kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        move_block(begin, end, from, to, blocks[block]);
    });
    for (const BlockCounts& block : blocks) {
        statistics.contacts += block.contacts;
        statistics.budget_exhausted += block.budget_exhausted;
        statistics.stayed += block.stayed;
        statistics.frozen += block.frozen;
        statistics.lost_impulses += block.lost_impulses;
        statistics.bounces_per_step_max = std::max(statistics.bounces_per_step_max, block.bounces_max);
        statistics.unsimulated_time += block.unsimulated;
    }
    statistics.particle_steps += count;
    if (options.record_contacts) collect_records(blocks);
}

// Within a particle the order of impacts is that of time already, so a stable sort by (time, id) settles everything.
void Simulation::Impl::collect_records(std::vector<BlockCounts>& blocks) {
    records.clear();
    for (const BlockCounts& block : blocks) records.insert(records.end(), block.records.begin(), block.records.end());
    std::stable_sort(records.begin(), records.end(), [](const ContactRecord& a, const ContactRecord& b) {
        return a.time != b.time ? a.time < b.time : a.particle < b.particle;
    });
}

void Simulation::Impl::move_block(std::size_t begin, std::size_t end, double from, double to, BlockCounts& counts) {
    thread_local MoveScratch scratch;
    scratch.hits.clear();
    scratch.records.clear();
    scratch.record_contacts = options.record_contacts;
    for (std::size_t i = begin; i < end; ++i) {
        if (particles.frozen[i] != 0) continue;
        const double start = std::max(from, particles.birth_time[i]);
        const double stop = std::min(to, particles.birth_time[i] + particles.lifetime[i]);
        if (stop <= start || stays_at_rest(i, start)) continue;
        MovingParticle moving{input(i, start), particles.spin[i], particles.id[i], particles.draws[i]};
        const MoveOutcome outcome = response.move(moving, stop - start, scratch);
        store(i, moving, outcome);
        counts.add(outcome);
    }
    if (!totals.empty()) add_hits(scratch.hits, counts);
    if (options.record_contacts) counts.records = scratch.records;
}

// What holds a particle under steady forces holds it for good, so asking again is not needed; the answer is the same.
bool Simulation::Impl::stays_at_rest(std::size_t i, double now) const {
    if (particles.resting[i] == 0) return false;
    if (options.sleeping && forces.is_steady()) return true;
    const MovingParticle moving{input(i, now), {}, particles.id[i], particles.draws[i]};
    Support support;
    for (const SurfaceId surface : particles.support[i]) {
        if (support.count > 0 && surface == support.surfaces[support.count - 1U]) break;
        support.surfaces[support.count++] = surface;
    }
    return response.still_holds(moving, support);
}

void Simulation::Impl::store(std::size_t i, const MovingParticle& moving, const MoveOutcome& outcome) {
    particles.position[i] = moving.state.position;
    particles.velocity[i] = moving.state.velocity;
    particles.spin[i] = moving.spin;
    particles.draws[i] = moving.draws;
    particles.unsimulated_time[i] += outcome.unsimulated_time;
    particles.contacts[i] += outcome.bounces;
    particles.resting[i] = outcome.resting ? 1 : 0;
    particles.frozen[i] = outcome.frozen ? 1 : 0;
    particles.absorbed[i] = outcome.absorbed ? 1 : 0;
    if (!outcome.resting) return;
    particles.support[i].fill(outcome.support.surfaces[outcome.support.count - 1U]);
    std::copy_n(outcome.support.surfaces.begin(), outcome.support.count, particles.support[i].begin());
}

void Simulation::Impl::add_hits(const std::vector<SurfaceHit>& hits, BlockCounts& counts) {
    for (const SurfaceHit& hit : hits) {
        SurfaceTotals& total = totals[hit.surface];
        if (hit.impact) total.hits.fetch_add(1, std::memory_order_relaxed);
        const bool x = total.x.add(hit.impulse.x, kImpulseUnit);
        const bool y = total.y.add(hit.impulse.y, kImpulseUnit);
        const bool z = total.z.add(hit.impulse.z, kImpulseUnit);
        counts.lost_impulses += x && y && z ? 0 : 1;
    }
}

void Simulation::Impl::retire(double now) {
    std::vector<std::uint8_t> keep(particles.size(), 1);
    bool any = false;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const bool expired = particles.birth_time[i] + particles.lifetime[i] <= now;
        const bool outside = bounds && !bounds->contains(particles.position[i]);
        const bool absorbed = particles.absorbed[i] != 0;
        statistics.absorbed += absorbed ? 1 : 0;
        statistics.expired += !absorbed && expired ? 1 : 0;
        statistics.out_of_bounds += !absorbed && !expired && outside ? 1 : 0;
        keep[i] = absorbed || expired || outside ? 0 : 1;
        any = any || keep[i] == 0;
    }
    if (any) particles.compact(keep);
    statistics.resting = static_cast<std::uint64_t>(std::count(particles.resting.begin(), particles.resting.end(), 1));
    statistics.asleep = options.sleeping && forces.is_steady() ? statistics.resting : 0;
}

Simulation::Simulation(SimulationSetup setup) : impl_(std::make_unique<Impl>(std::move(setup))) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

void Simulation::step() {
    if (finished()) return;
    const double from = impl_->time_at(impl_->statistics.steps);
    const double to = impl_->time_at(impl_->statistics.steps + 1);
    impl_->emit(from, to);
    impl_->move_all(from, to);
    impl_->retire(to);
    ++impl_->statistics.steps;
}

bool Simulation::finished() const { return impl_->statistics.steps >= impl_->steps; }
double Simulation::time() const { return impl_->time_at(impl_->statistics.steps); }
std::uint64_t Simulation::step_index() const { return impl_->statistics.steps; }
std::uint64_t Simulation::step_count() const { return impl_->steps; }
const SimulationOptions& Simulation::options() const { return impl_->options; }
const Particles& Simulation::particles() const { return impl_->particles; }
const SimulationStatistics& Simulation::statistics() const { return impl_->statistics; }
const std::vector<ColliderDescription>& Simulation::colliders() const { return impl_->world.colliders(); }
std::optional<TriangleMesh> Simulation::collider_mesh(std::size_t i) const { return impl_->world.mesh_of(i); }
std::size_t Simulation::triangle_count() const { return impl_->world.triangles().size(); }
std::size_t Simulation::degenerate_triangles() const { return impl_->world.degenerate_triangles(); }

const std::vector<ContactRecord>& Simulation::contact_records() const { return impl_->records; }
SurfaceName Simulation::surface_name(SurfaceId surface) const { return impl_->world.name_of(surface); }

TriangleTotals Simulation::triangle_totals(std::size_t i) const {
    TriangleTotals result;
    if (impl_->totals.empty()) return result;
    const std::size_t first = impl_->world.first_surface_of(i);
    for (std::size_t k = 0; k < impl_->world.surface_count_of(i); ++k) {
        const SurfaceTotals& total = impl_->totals[first + k];
        result.hits.push_back(total.hits.load(std::memory_order_relaxed));
        result.impulse.push_back(
            {total.x.value(kImpulseUnit), total.y.value(kImpulseUnit), total.z.value(kImpulseUnit)});
    }
    return result;
}

double Simulation::kinetic_energy() const {
    const Particles& particles = impl_->particles;
    const std::vector<std::uint32_t> order = impl_->particles.order_by_id();
    return ordered_sum(order.size(), kBlock, [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = order[k];
            const double r = particles.radius[i];
            const double turning = 0.4 * r * r * length_squared(particles.spin[i]);  // solid sphere, 2/5 m r^2
            sum += 0.5 * particles.mass[i] * (length_squared(particles.velocity[i]) + turning);
        }
        return sum;
    });
}

std::optional<double> Simulation::potential_energy() const {
    const std::vector<std::uint32_t> order = impl_->particles.order_by_id();
    std::atomic<bool> defined{true};
    const double now = time();
    const double sum = ordered_sum(order.size(), kBlock, [&](std::size_t begin, std::size_t end) {
        double partial = 0.0;
        for (std::size_t k = begin; k < end; ++k) {
            const auto energy = impl_->forces.potential_energy(impl_->input(order[k], now));
            if (!energy) defined = false;
            partial += energy.value_or(0.0);
        }
        return partial;
    });
    return defined ? std::optional(sum) : std::nullopt;
}

std::uint64_t Simulation::state_hash() const {
    StateHash hash;
    for (const std::uint32_t i : impl_->particles.order_by_id()) {
        hash.add(impl_->particles.id[i]);
        hash.add(impl_->particles.position[i]);
        hash.add(impl_->particles.velocity[i]);
    }
    return hash.value();
}

}  // namespace ricochet
