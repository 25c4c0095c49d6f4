#include "ricochet/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ricochet/collision/collision_world.h"
#include "ricochet/core/error.h"
#include "ricochet/core/fixed_point_sum.h"
#include "ricochet/core/hash.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/coupled_motion.h"
#include "ricochet/dynamics/spring_stability.h"
#include "ricochet/geometry/predicates.h"
#include "ricochet/geometry/shape_mesh.h"
#include "ricochet/offspring.h"
#include "ricochet/response/penalty.h"
#include "ricochet/response/rollback.h"
#include "ricochet/run_check.h"

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
    if (!(options.frame_rate > 0.0) || !std::isfinite(options.frame_rate)) {
        throw InputError("frame_rate must be a finite number above 0 frames a second");
    }
    if (options.bounce_budget == 0) throw InputError("bounce_budget must be at least 1");
    return options;
}

/// Throws where a collider or one of its triangles names a material that is not there.
std::vector<Material> checked_materials(std::vector<Material> materials,
                                        const std::vector<ColliderDescription>& colliders) {
    for (const ColliderDescription& collider : colliders) {
        if (collider.material >= materials.size())
            throw InputError("collider \"" + collider.name + "\" has no material");
        const auto* const mesh = std::get_if<MeshShape>(&collider.shape);
        if (mesh == nullptr || mesh->triangle_materials.empty()) continue;
        const auto& list = mesh->triangle_materials;
        if (*std::max_element(list.begin(), list.end()) >= materials.size())
            throw InputError("collider \"" + collider.name + "\" has triangles without a material");
    }
    return materials;
}

bool makes_spheres(const SimulationSetup& setup) {
    return std::any_of(setup.particles.begin(), setup.particles.end(),
                       [](const Particle& particle) { return particle.radius > 0.0; }) ||
           std::any_of(setup.emitters.begin(), setup.emitters.end(), [](const EmitterDescription& emitter) {
               return emitter.radius.mean > 0.0 || emitter.radius.spread > 0.0;
           });
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
    std::uint64_t trials = 0;
    std::uint64_t penetrations = 0;
    double unsimulated = 0.0;
    double penetration_sum = 0.0;
    double penetration_deepest = 0.0;
    std::vector<ContactRecord> records;
    std::vector<Violation> violations;
    std::optional<std::size_t> runaway;  ///< the first particle that forces have brought beyond kFastestSpeed

    void add(const MoveOutcome& outcome) {
        contacts += outcome.bounces;
        stayed += outcome.stayed;
        frozen += outcome.frozen ? 1 : 0;
        budget_exhausted += outcome.unsimulated_time > 0.0 ? 1 : 0;
        unsimulated += outcome.unsimulated_time;
        bounces_max = std::max(bounces_max, outcome.bounces);
        trials += outcome.trials;
        penetrations += outcome.depth > 0.0 ? 1 : 0;
        penetration_sum += outcome.depth;
        penetration_deepest = std::max(penetration_deepest, outcome.depth);
    }
    void add_to(SimulationStatistics& statistics) const {
        statistics.contacts += contacts;
        statistics.budget_exhausted += budget_exhausted;
        statistics.stayed += stayed;
        statistics.frozen += frozen;
        statistics.lost_impulses += lost_impulses;
        statistics.bounces_per_step_max = std::max(statistics.bounces_per_step_max, bounces_max);
        statistics.unsimulated_time += unsimulated;
        statistics.trials += trials;
        statistics.penetrations += penetrations;
        statistics.penetration_sum += penetration_sum;
        statistics.penetration_deepest = std::max(statistics.penetration_deepest, penetration_deepest);
    }
};

ResponseSettings response_settings(const SimulationOptions& options) {
    return {options.integrator, options.resting_speed, options.bounce_budget, options.seed,
            options.time_step,  options.rollback,      options.project,       options.penalty};
}

double lightest_particle(const SimulationSetup& setup) {
    double lightest = std::numeric_limits<double>::infinity();
    for (const Particle& particle : setup.particles) lightest = std::min(lightest, particle.mass);
    for (const auto& emitter : setup.emitters) lightest = std::min(lightest, emitter.mass.mean - emitter.mass.spread);
    return lightest;
}

/// Smallest restitution among the materials that surfaces use.
double least_restitution(const SimulationSetup& setup) {
    double least = 1.0;
    const auto use = [&](std::uint32_t material) {
        if (material < setup.materials.size()) least = std::min(least, setup.materials[material].restitution);
    };
    for (const ColliderDescription& collider : setup.colliders) {
        use(collider.material);
        const auto* const mesh = std::get_if<MeshShape>(&collider.shape);
        if (mesh != nullptr) std::for_each(mesh->triangle_materials.begin(), mesh->triangle_materials.end(), use);
    }
    return least;
}

/// The sub-step against the stability bound of the lightest particle on the dampest of the surfaces.
std::vector<std::string> penalty_warnings(const SimulationSetup& setup) {
    const SimulationOptions& options = setup.options;
    const double mass = lightest_particle(setup);
    if (options.response != ResponseKind::penalty || setup.colliders.empty() || !std::isfinite(mass)) return {};
    const double restitution = least_restitution(setup);
    const ContactSpring spring = contact_spring(response_settings(options), mass, restitution);
    const double bound = longest_stable_step(spring, mass);
    const double substep = options.time_step / options.penalty.substeps;
    if (substep <= bound) return {};
    const std::string advice =
        options.penalty.stiffness
            ? fmt::format("use at least {} substeps or a softer spring", std::ceil(options.time_step / bound))
            : fmt::format("use contact_steps of at least {}",
                          std::ceil(options.penalty.contact_steps * substep / bound));
    return {
        fmt::format("the penalty sub-step of {:.3g} s exceeds the stability bound of {:.3g} s (stiffness {:.3g} N/m, "
                    "lightest particle {:.3g} kg, restitution {}): contacts may explode; {}",
                    substep, bound, spring.stiffness, mass, restitution, advice)};
}

std::vector<std::string> spring_warnings(const SimulationSetup& setup) {
    if (setup.solver) return {};
    const IntegratorKind kind = setup.options.integrator.kind;
    const double bound = longest_stable_step(kind, setup.springs, setup.particles);
    if (setup.options.time_step <= bound) return {};
    return {
        fmt::format("the time step of {:.3g} s exceeds {:.3g} s, up to which {} is sure to be stable with these "
                    "springs: they may explode; use a shorter step or the integrator implicit_euler",
                    setup.options.time_step, bound, name_of(kind))};
}

std::vector<std::string> warnings_of(const SimulationSetup& setup) {
    std::vector<std::string> warnings = penalty_warnings(setup);
    for (std::string& warning : spring_warnings(setup)) warnings.push_back(std::move(warning));
    return warnings;
}

}  // namespace

struct Simulation::Impl {
    explicit Impl(SimulationSetup setup);

    [[nodiscard]] bool has_energy(std::size_t i) const;
    void emit(double from, double to);
    void add(Particle particle);
    void move_all(double from, double to);
    void move_from(std::size_t first, double from, double to);
    void bear_children(double from, double to);
    [[nodiscard]] bool keeps_records() const { return options.record_contacts || offspring; }
    void move_part(std::size_t first, double from, double to, std::vector<BlockCounts>& blocks);
    void stop_runaways(const std::vector<BlockCounts>& blocks, double to) const;
    void move_block(std::size_t begin, std::size_t end, double from, double to, BlockCounts& counts);
    void add_hits(const std::vector<SurfaceHit>& hits, BlockCounts& counts);
    void collect_records(std::vector<BlockCounts>& blocks);
    void sort_records();
    // What holds a particle under steady forces holds it for good, so asking again is not needed.
    [[nodiscard]] bool is_asleep(std::size_t i) const { return particles.held[i] != 0 && may_sleep; }
    [[nodiscard]] MovingParticle moving(std::size_t i, double start);
    [[nodiscard]] std::span<SideMemory> sides_of(std::size_t i);
    void move_system(std::size_t first, double from, double to, std::vector<BlockCounts>& blocks);
    void compact(const std::vector<std::uint8_t>& keep);
    void add_weight(std::size_t i, double until, double sign, BlockCounts& counts);
    void add_weights_of_sleepers(double sign);
    void collect_violations(const std::vector<BlockCounts>& blocks);
    void store(std::size_t i, const MovingParticle& moving, const MoveOutcome& outcome);
    void retire(double now);
    [[nodiscard]] bool starts_in_overlap(const Particle& particle) const;
    [[nodiscard]] double time_at(std::uint64_t step) const {
        return step >= steps ? options.duration : static_cast<double>(step) * options.time_step;
    }
    [[nodiscard]] ForceInput input(std::size_t i, double now) const {
        return {particles.position[i], particles.velocity[i], particles.mass[i], particles.radius[i], now,
                particles.id[i]};
    }

    SimulationOptions options;
    std::vector<std::string> warnings;
    ForceField forces;
    std::vector<Material> materials;
    CollisionWorld world;
    CoupledMotion coupled;
    std::vector<Emitter> emitters;
    std::optional<Box3> bounds;
    std::unique_ptr<Response> response;
    std::vector<SideMemory> sides;  ///< one a collider for every particle, for responses that keep sides
    Particles particles;
    std::vector<SpringFace> spring_faces;
    SimulationStatistics statistics;
    std::vector<SurfaceTotals> totals;
    std::vector<ContactRecord> records;       ///< of the step
    std::vector<ContactRecord> pass_records;  ///< of the particles that were moved last, for their children
    std::unique_ptr<Offspring> offspring;     ///< where particles are born of particles
    std::unique_ptr<RunCheck> check;          ///< with options.verify
    std::vector<Violation> violations;
    std::vector<Violation> last_violations;
    std::uint64_t steps;
    std::uint64_t next_id = 0;
    bool may_sleep;
    bool has_spheres = false;
};

Simulation::Impl::Impl(SimulationSetup setup)
    : options(checked(setup.options)),
      warnings(warnings_of(setup)),
      forces(std::move(setup.forces)),
      materials(checked_materials(std::move(setup.materials), setup.colliders)),
      world(std::move(setup.colliders)),
      coupled(std::move(setup.springs), std::move(setup.solver), forces, options.integrator),
      bounds(setup.bounds),
      response(make_response(options.response, {world, forces, materials, response_settings(options)})),
      totals(options.triangle_totals ? world.surface_count() : 0),
      steps(count_steps(options)),
      may_sleep(options.sleeping && forces.is_steady()) {
    world.set_culling(options.culling);
    has_spheres = makes_spheres(setup);
    particles.attributes = AttributeTable(setup.attributes);
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        const EmitterDescription& emitter = setup.emitters[k];
        particles.keeps_origin = particles.keeps_origin || emitter.parent || !emitter.curves.empty();
        emitters.emplace_back(std::move(setup.emitters[k]), options.seed, static_cast<std::uint32_t>(k),
                              EmitterSurroundings{options.frame_rate, setup.reference_camera, setup.attributes});
    }
    offspring = std::make_unique<Offspring>(emitters, OffspringLimits{options.max_depth, options.most_particles});
    if (offspring->empty()) offspring.reset();
    for (const Particle& particle : setup.particles) add(particle);
    spring_faces = std::move(setup.spring_faces);
    if (coupled.is_active()) coupled.bind(particles);
    if (options.verify) check = std::make_unique<RunCheck>(world);
}

void Simulation::Impl::add(Particle particle) {
    particle.id = next_id++;
    particle.position = flush_tiny(particle.position);
    const auto size = particles.attributes.find(kSizeAttribute);
    if (size) {
        particle.attributes.resize(particles.attributes.columns().size(), missing_attribute());
        if (is_missing(particle.attributes[*size])) particle.attributes[*size] = {particle.radius, 0.0, 0.0};
    }
    if (particle.pinned) particle.velocity = particle.spin = Vec3{};
    world.prepare_radius(particle.radius);
    if (starts_in_overlap(particle)) ++statistics.started_inside;
    particles.append(particle);
    if (response->keeps_sides()) {
        sides.resize(particles.size() * world.colliders().size());
        if (is_finite(particle.position)) response->first_sides(particle.position, sides_of(particles.size() - 1));
    }
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
    const std::uint64_t room =
        options.most_particles - std::min<std::uint64_t>(options.most_particles, particles.size());
    const std::size_t allowed = std::min<std::uint64_t>(born.size(), room);
    statistics.births_refused_by_population += born.size() - allowed;
    for (std::size_t k = 0; k < allowed; ++k) add(born[k]);
    if (allowed > 0 && coupled.is_active()) coupled.bind(particles);
}

// Particles that are born of particles inside the step are moved from their births to its end, with their own children
// in turn.
void Simulation::Impl::move_all(double from, double to) {
    records.clear();
    last_violations.clear();
    std::size_t first = 0;
    const std::uint64_t emitted_before = statistics.emitted;
    do {
        const std::size_t end = particles.size();
        if (offspring) offspring->before_move(particles, first);
        move_from(first, from, to);
        if (offspring) bear_children(from, to);
        if (check) check->watch_newborn(particles);
        first = end;
    } while (first < particles.size());
    if (statistics.emitted > emitted_before && coupled.is_active()) coupled.bind(particles);
    if (options.record_contacts) sort_records();
}

void Simulation::Impl::bear_children(double from, double to) {
    OffspringCounts counts;
    for (Particle& child : offspring->after_move(world, particles, from, to, std::move(pass_records), counts)) {
        add(std::move(child));
    }
    statistics.children += counts.children;
    statistics.births_refused_by_depth += counts.refused_by_depth;
    statistics.births_refused_by_population += counts.refused_by_population;
}

// Particles that act on each other are planned together first; an adaptive plan may cut the step into parts. The
// newborn join them with the next step.
void Simulation::Impl::move_from(std::size_t first, double from, double to) {
    const std::size_t count = particles.size() - first;
    std::vector<BlockCounts> blocks((count + kBlock - 1) / kBlock);
    const bool is_planned = coupled.is_active() && first == 0;
    for (double now = from; now < to;) {
        const double whole = to - now;
        const double planned = is_planned ? coupled.plan(particles, now, whole) : whole;
        const double next = planned < whole ? now + planned : to;
        move_part(first, now, next, blocks);
        now = next;
    }
    stop_runaways(blocks, to);
    if (is_planned) coupled.settle(particles);
    for (const BlockCounts& block : blocks) block.add_to(statistics);
    statistics.particle_steps += count;
    statistics.unsolved_steps = coupled.unsolved_steps();
    if (keeps_records()) collect_records(blocks);
    if (check) collect_violations(blocks);
}

void Simulation::Impl::move_part(std::size_t first, double from, double to, std::vector<BlockCounts>& blocks) {
    if (options.response == ResponseKind::rollback && options.rollback.global) {
        move_system(first, from, to, blocks);
        return;
    }
    parallel_for_blocks(particles.size() - first, kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        move_block(first + begin, first + end, from, to, blocks[block]);
    });
}

void Simulation::Impl::stop_runaways(const std::vector<BlockCounts>& blocks, double to) const {
    const auto found = std::find_if(blocks.begin(), blocks.end(), [](const auto& block) { return block.runaway; });
    if (found == blocks.end()) return;
    const std::size_t i = *found->runaway;
    throw DivergedError(fmt::format(
        "by t = {:.6g} s forces have brought particle {} to {:.3g} m/s, beyond the speed of light: the motion has "
        "diverged; use a shorter time step, the integrator implicit_euler, or weaker forces",
        to, particles.id[i], length(particles.velocity[i])));
}

void Simulation::Impl::collect_violations(const std::vector<BlockCounts>& blocks) {
    for (const BlockCounts& block : blocks) {
        statistics.violations += block.violations.size();
        last_violations.insert(last_violations.end(), block.violations.begin(), block.violations.end());
        const std::size_t kept = std::min(block.violations.size(), kMostViolations - violations.size());
        violations.insert(violations.end(), block.violations.begin(),
                          block.violations.begin() + static_cast<std::ptrdiff_t>(kept));
    }
}

void Simulation::Impl::collect_records(std::vector<BlockCounts>& blocks) {
    pass_records.clear();
    for (const BlockCounts& block : blocks) {
        pass_records.insert(pass_records.end(), block.records.begin(), block.records.end());
    }
    if (options.record_contacts) records.insert(records.end(), pass_records.begin(), pass_records.end());
}

// Within a particle the order of impacts is that of time already, so a stable sort by (time, id) settles everything.
void Simulation::Impl::sort_records() {
    std::stable_sort(records.begin(), records.end(), [](const ContactRecord& a, const ContactRecord& b) {
        return a.time != b.time ? a.time < b.time : a.particle < b.particle;
    });
}

void Simulation::Impl::move_block(std::size_t begin, std::size_t end, double from, double to, BlockCounts& counts) {
    thread_local MoveScratch scratch;
    scratch.hits.clear();
    scratch.records.clear();
    scratch.record_contacts = keeps_records();
    scratch.record_legs = check != nullptr;
    for (std::size_t i = begin; i < end; ++i) {
        if (particles.frozen[i] != 0 || particles.pinned[i] != 0 || particles.absorbed[i] != 0) continue;
        const double start = std::max(from, particles.birth_time[i]);
        const double stop = std::min(to, particles.birth_time[i] + particles.lifetime[i]);
        if (stop <= start || is_asleep(i)) continue;
        MovingParticle particle = moving(i, start);
        scratch.legs.clear();
        // A planned flight's duration need not be the difference of the clock's times to the last bit.
        const bool as_planned = particle.planned != nullptr && start == from && stop == to;
        const double duration = as_planned ? particle.planned->path.duration : stop - start;
        const MoveOutcome outcome = response->move(particle, duration, scratch);
        if (check) check->look_at(i, particles, particle.state, stop, scratch.legs, counts.violations);
        const bool was_slow = length_squared(particles.velocity[i]) <= kFastestSpeed * kFastestSpeed;
        store(i, particle, outcome);
        if (was_slow && length_squared(particles.velocity[i]) > kFastestSpeed * kFastestSpeed && !counts.runaway) {
            counts.runaway = i;
        }
        particles.booked_until[i] = stop;
        counts.add(outcome);
    }
    if (!totals.empty()) add_hits(scratch.hits, counts);
    counts.records.insert(counts.records.end(), scratch.records.begin(), scratch.records.end());
}

// All particles go back together: see rollback.h.
void Simulation::Impl::move_system(std::size_t first, double from, double to, std::vector<BlockCounts>& blocks) {
    std::vector<SystemParticle> system(particles.size() - first);
    for (std::size_t k = 0; k < system.size(); ++k) {
        const std::size_t i = first + k;
        const double start = std::max(from, particles.birth_time[i]);
        const double stop = std::min(to, particles.birth_time[i] + particles.lifetime[i]);
        system[k].particle = moving(i, start);
        system[k].start = start;
        system[k].stop = stop;
        system[k].is_out = particles.frozen[i] != 0 || particles.pinned[i] != 0;
    }
    std::vector<MoveScratch> scratch(blocks.size());
    for (MoveScratch& block : scratch) {
        block.record_contacts = keeps_records();
        block.record_legs = check != nullptr;
    }
    move_together(response->rules(), system, from, to, scratch, kBlock);
    for (std::size_t k = 0; k < system.size(); ++k) {
        const std::size_t i = first + k;
        SystemParticle& moved = system[k];
        if (particles.frozen[i] != 0 || particles.pinned[i] != 0 || moved.stop <= moved.start) continue;
        BlockCounts& counts = blocks[k / kBlock];
        if (check) check->look_at(i, particles, moved.particle.state, moved.stop, moved.legs, counts.violations);
        store(i, moved.particle, moved.outcome);
        particles.booked_until[i] = moved.stop;
        counts.add(moved.outcome);
    }
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        if (!totals.empty()) add_hits(scratch[k].hits, blocks[k]);
        if (keeps_records()) blocks[k].records = std::move(scratch[k].records);
    }
}

MovingParticle Simulation::Impl::moving(std::size_t i, double start) {
    MovingParticle particle{input(i, start), particles.spin[i], particles.id[i], particles.draws[i], {}};
    Support& support = particle.support;
    for (const SurfaceId surface : particles.support[i]) {
        if (surface != kNoSupport) support.surfaces[support.count++] = surface;
    }
    support.cascade_left = particles.cascade_left[i];
    particle.sides = sides_of(i);
    if (offspring) particle.shatter_impulse = offspring->shatter_impulse(particles, i);
    particle.planned = coupled.flight_of(i);
    particle.state.coupling = coupled.coupling_of(i);
    return particle;
}

std::span<SideMemory> Simulation::Impl::sides_of(std::size_t i) {
    if (sides.empty()) return {};
    const std::size_t colliders = world.colliders().size();
    return {sides.data() + i * colliders, colliders};
}

void Simulation::Impl::store(std::size_t i, const MovingParticle& moving, const MoveOutcome& outcome) {
    particles.position[i] = moving.state.position;
    particles.velocity[i] = moving.state.velocity;
    particles.spin[i] = moving.spin;
    particles.draws[i] = moving.draws;
    particles.unsimulated_time[i] += outcome.unsimulated_time;
    particles.contacts[i] += outcome.bounces;
    particles.resting[i] = outcome.resting ? 1 : 0;
    particles.held[i] = outcome.held && !coupled.holds(i) ? 1 : 0;
    particles.frozen[i] = outcome.frozen ? 1 : 0;
    particles.absorbed[i] = outcome.shattered ? kShattered : outcome.absorbed ? 1 : 0;
    particles.support[i].fill(kNoSupport);
    std::copy_n(moving.support.surfaces.begin(), moving.support.count, particles.support[i].begin());
    particles.cascade_left[i] = moving.support.cascade_left;
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

// The impulse of a sleeping particle's weight since it was last moved, or (sign -1) exactly that taken back.
void Simulation::Impl::add_weight(std::size_t i, double until, double sign, BlockCounts& counts) {
    const double elapsed = until - particles.booked_until[i];
    if (totals.empty() || !is_asleep(i) || !(elapsed > 0.0)) return;
    std::vector<SurfaceHit> hits;
    response->add_weight(moving(i, until), elapsed, hits);
    for (SurfaceHit& hit : hits) hit.impulse *= sign;
    add_hits(hits, counts);
}

void Simulation::Impl::add_weights_of_sleepers(double sign) {
    const double now = time_at(statistics.steps);
    BlockCounts counts;  // an overflow is counted when the weight is booked for good
    for (std::size_t i = 0; i < particles.size(); ++i) add_weight(i, now, sign, counts);
}

void Simulation::Impl::retire(double now) {
    std::vector<std::uint8_t> keep(particles.size(), 1);
    bool any = false;
    BlockCounts counts;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const bool expired = particles.birth_time[i] + particles.lifetime[i] <= now;
        const bool outside = bounds && !bounds->contains(particles.position[i]);
        const bool absorbed = particles.absorbed[i] != 0;
        const bool shattered = particles.absorbed[i] == kShattered;
        statistics.absorbed += absorbed && !shattered ? 1 : 0;
        statistics.shattered += shattered ? 1 : 0;
        statistics.expired += !absorbed && expired ? 1 : 0;
        statistics.out_of_bounds += !absorbed && !expired && outside ? 1 : 0;
        keep[i] = absorbed || expired || outside ? 0 : 1;
        if (keep[i] == 0) add_weight(i, std::min(now, particles.birth_time[i] + particles.lifetime[i]), 1.0, counts);
        any = any || keep[i] == 0;
    }
    statistics.lost_impulses += counts.lost_impulses;
    if (any) compact(keep);
    if (any && coupled.is_active()) coupled.bind(particles);
    statistics.springs_broken = coupled.springs().broken();
    statistics.springs_lost = coupled.springs().lost();
    statistics.resting = static_cast<std::uint64_t>(std::count(particles.resting.begin(), particles.resting.end(), 1));
    const auto held = static_cast<std::uint64_t>(std::count(particles.held.begin(), particles.held.end(), 1));
    statistics.asleep = may_sleep ? held : 0;
}

void Simulation::Impl::compact(const std::vector<std::uint8_t>& keep) {
    if (!sides.empty()) {
        const auto colliders = static_cast<std::ptrdiff_t>(world.colliders().size());
        auto kept = sides.begin();
        for (std::size_t i = 0; i < keep.size(); ++i) {
            const auto first = sides.begin() + static_cast<std::ptrdiff_t>(i) * colliders;
            if (keep[i] != 0) kept = std::copy_n(first, colliders, kept);
        }
        sides.erase(kept, sides.end());
    }
    particles.compact(keep);
    if (check) check->compact(keep);
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
    if (impl_->check) impl_->check->watch_newborn(impl_->particles);
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
AttributeTable Simulation::shown_attributes() const {
    const Particles& particles = impl_->particles;
    AttributeTable shown = particles.attributes;
    if (!particles.keeps_origin || shown.empty()) return shown;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (particles.origin[i].emitter == kNoEmitter) continue;
        const auto& curves = impl_->emitters[particles.origin[i].emitter].description().curves;
        if (curves.empty()) continue;
        for (std::size_t k = 0; k < shown.columns().size(); ++k) {
            const double age = time() - particles.birth_time[i];
            shown.set(k, i,
                      shown_value(curves, shown.columns()[k].name, shown.value(k, i), age, particles.lifetime[i]));
        }
    }
    return shown;
}
const std::vector<SpringFace>& Simulation::spring_faces() const { return impl_->spring_faces; }
const SimulationStatistics& Simulation::statistics() const { return impl_->statistics; }
const std::vector<ColliderDescription>& Simulation::colliders() const { return impl_->world.colliders(); }
const SpringNetwork& Simulation::springs() const { return impl_->coupled.springs(); }
std::optional<TriangleMesh> Simulation::collider_mesh(std::size_t i) const {
    const ColliderShape& shape = impl_->world.colliders()[i].shape;
    if (const auto* ball = std::get_if<BallShape>(&shape)) return ball_mesh(ball->radius, ball->placement);
    if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
        return cylinder_mesh(cylinder->radius, cylinder->height, cylinder->placement);
    }
    return impl_->world.mesh_of(i);
}
std::size_t Simulation::triangle_count() const { return impl_->world.triangles().size(); }
std::size_t Simulation::degenerate_triangles() const { return impl_->world.degenerate_triangles(); }

const std::vector<ContactRecord>& Simulation::contact_records() const { return impl_->records; }
CollisionWorld::Place Simulation::contact_place(const ContactRecord& record) const {
    return impl_->world.place_on(record.surface, record.position);
}
SurfaceName Simulation::surface_name(SurfaceId surface) const { return impl_->world.name_of(surface); }

TriangleTotals Simulation::triangle_totals(std::size_t i) const {
    TriangleTotals result;
    if (impl_->totals.empty()) return result;
    // Sleepers' weight is lent to the totals: it comes out exactly as it went in.
    impl_->add_weights_of_sleepers(1.0);
    const std::size_t first = impl_->world.first_surface_of(i);
    for (std::size_t k = 0; k < impl_->world.surface_count_of(i); ++k) {
        const SurfaceTotals& total = impl_->totals[first + k];
        result.hits.push_back(total.hits.load(std::memory_order_relaxed));
        result.impulse.push_back(
            {total.x.value(kImpulseUnit), total.y.value(kImpulseUnit), total.z.value(kImpulseUnit)});
    }
    impl_->add_weights_of_sleepers(-1.0);
    return result;
}

const std::vector<Violation>& Simulation::last_violations() const { return impl_->last_violations; }

bool Simulation::is_penetrating(std::size_t i) const {
    const std::span<const SideMemory> sides = impl_->sides_of(i);
    return std::any_of(sides.begin(), sides.end(), [](const SideMemory& memory) { return memory.penetrating; });
}

const std::vector<std::string>& Simulation::warnings() const { return impl_->warnings; }

bool Simulation::has_spheres() const { return impl_->has_spheres; }

// A state that is not finite and will be frozen by the next step counts as frozen already.
bool Simulation::Impl::has_energy(std::size_t i) const {
    return particles.frozen[i] == 0 && is_finite(particles.position[i]) && is_finite(particles.velocity[i]);
}
const std::vector<Violation>& Simulation::violations() const { return impl_->violations; }

double Simulation::kinetic_energy() const {
    const Particles& particles = impl_->particles;
    const std::vector<std::uint32_t> order = impl_->particles.order_by_id();
    return ordered_sum(order.size(), kBlock, [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = order[k];
            if (!impl_->has_energy(i)) continue;
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
            if (!impl_->has_energy(order[k])) continue;
            const auto energy = impl_->forces.potential_energy(impl_->input(order[k], now));
            if (!energy) defined = false;
            partial += energy.value_or(0.0);
        }
        return partial;
    });
    const double stored = impl_->coupled.springs().potential_energy(particles().position);
    return defined ? std::optional(sum + stored) : std::nullopt;
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
