#include "simulation/books.h"

#include <algorithm>
#include <utility>

#include "ricochet/core/random.h"
#include "ricochet/dynamics/flows.h"
#include "support/integrators.h"

namespace ricochet::test {
namespace {

constexpr std::array<const char*, kFeatures.size()> kFeatureNames{"springs", "children", "absorbing", "shattering",
                                                                  "flow"};

std::vector<Particle> moving_particles(std::uint64_t seed) {
    RandomSequence random(seed, 0, 0);
    std::vector<Particle> particles(kParticles);
    for (std::uint32_t k = 0; k < kParticles; ++k) {
        particles[k].position = {0.2 * (k % 4) - 0.3, 0.2 * (k / 4) - 0.2, 0.05 * (k % 3) - 0.05};
        particles[k].velocity = 2.0 * random.unit_vector();
        particles[k].mass = kMass;
    }
    return particles;
}

/// Emits each particle from its own emitter, so that it may have children.
std::uint32_t emit(const Particle& particle, SimulationSetup& setup) {
    EmitterDescription emitter;
    emitter.name = "parent " + std::to_string(setup.emitters.size());
    emitter.shape = PointShape{particle.position};
    emitter.burst = 1;
    emitter.velocity = particle.velocity;
    emitter.mass = {particle.mass, 0.0};
    setup.emitters.push_back(emitter);
    return static_cast<std::uint32_t>(setup.emitters.size() - 1);
}

void add_children(std::uint32_t parent, bool shatters, SimulationSetup& setup) {
    EmitterDescription child;
    child.name = (shatters ? "fragment " : "child ") + std::to_string(setup.emitters.size());
    child.parent = ParentRule{};
    child.parent->emitter = parent;
    child.parent->on = shatters ? BirthEvent::impact : BirthEvent::life;
    child.parent->share = shatters;
    child.parent->count = {3.0, 0.0};
    child.parent->inherit_velocity = shatters ? 1.0 : 0.0;
    child.rate = {20.0, 0.0};
    child.mass = {kChildMass, 0.0};
    child.speed = {shatters ? kLaunch : 0.0, 0.0};
    setup.emitters.push_back(child);
}

void join(std::size_t count, SimulationSetup& setup) {
    for (std::uint64_t k = 1; k < count; ++k) {
        if (k % 4 != 0) setup.springs.push_back({k - 1, k, 0.2, kStiffness, 0.0});
    }
}

/// Returns the emitters whose particles bring their own mass.
std::vector<std::uint32_t> bearing_of(const SimulationSetup& setup) {
    std::vector<std::uint32_t> bearing;
    for (std::uint32_t k = 0; k < setup.emitters.size(); ++k) {
        const auto& rule = setup.emitters[k].parent;
        if (rule && !rule->share) bearing.push_back(k);
    }
    return bearing;
}

}  // namespace

std::string name(const BookCase& c) {
    std::string text = std::string(name_of(c.response)) + (c.global ? ".global" : "") + ", " +
                       std::string(name_of(c.integrator)) + ", ";
    bool is_first = true;
    for (std::size_t k = 0; k < kFeatures.size(); ++k) {
        if (!c.has(kFeatures[k])) continue;
        text += (is_first ? "" : " and ") + std::string(kFeatureNames[k]);
        is_first = false;
    }
    return text + ", " + std::to_string(c.time_step) + " s, seed " + std::to_string(c.seed);
}

std::vector<BookCase> all_methods() {
    std::vector<BookCase> cases;
    for (const IntegratorKind integrator : kAllIntegrators) {
        for (const ResponseKind response : response_kinds()) cases.push_back({response, false, integrator});
        cases.push_back({ResponseKind::rollback, true, integrator});
    }
    return cases;
}

std::optional<std::string> refusal(const BookCase& c) {
    const bool is_adaptive = c.integrator == IntegratorKind::dormand_prince;
    const bool is_implicit = c.integrator == IntegratorKind::implicit_euler;
    if (c.has(Feature::flow) && c.has(Feature::springs)) return "expected none: a flow carries the particles";
    if (c.response == ResponseKind::penalty && (is_adaptive || is_implicit)) return "with the penalty response";
    if (c.global && is_adaptive) return "with rollback.global";
    if (!c.has(Feature::flow)) return std::nullopt;
    if (c.response != ResponseKind::exact) return "expected exact: a flow carries the particles";
    const bool carries = is_adaptive || c.integrator == IntegratorKind::forward_euler ||
                         c.integrator == IntegratorKind::midpoint || c.integrator == IntegratorKind::rk4;
    if (!carries) return "which has no meaning where a flow carries the particles";
    return std::nullopt;
}

SimulationSetup setup_of(const BookCase& c) {
    SimulationSetup setup;
    setup.options.response = c.response;
    setup.options.rollback.global = c.global;
    setup.options.integrator = c.integrator;
    setup.options.time_step = c.time_step;
    setup.options.duration = kDuration;
    setup.options.record_contacts = true;
    if (c.has(Feature::flow)) setup.options.flow = make_wind({1.1, 0.4, -0.7});
    setup.materials = {{.name = "wall", .restitution = 1.0, .friction = 0.0}};
    if (c.has(Feature::absorbing)) setup.materials[0].absorption = 0.3;
    setup.colliders = {{"box", CuboidShape{{1, 1, 1}, {}}, 0}};
    const std::size_t explicit_count = !c.emits() ? kParticles : (c.has(Feature::springs) ? kParticles / 2 : 0);
    const std::vector<Particle> particles = moving_particles(c.seed);
    for (std::size_t k = 0; k < kParticles; ++k) {
        if (k < explicit_count) {
            setup.particles.push_back(particles[k]);
            continue;
        }
        const std::uint32_t parent = emit(particles[k], setup);
        if (c.has(Feature::children)) add_children(parent, false, setup);
        if (c.has(Feature::shattering)) add_children(parent, true, setup);
    }
    if (c.has(Feature::springs)) join(explicit_count, setup);
    return setup;
}

BookedRun::BookedRun(const BookCase& c) : BookedRun(c, setup_of(c)) {}

BookedRun::BookedRun(const BookCase& c, SimulationSetup setup)
    : bearing_(bearing_of(setup)), simulation_(std::move(setup)) {
    start_ = living();
    if (c.emits()) {
        simulation_.step();  // the step in which all independent particles and the first children are born
        note_step();
        start_ = living();
        born_ = {};
    }
}

void BookedRun::run() {
    while (!simulation_.finished()) {
        simulation_.step();
        note_step();
    }
}

Account BookedRun::living() const {
    Account account;
    const Particles& particles = simulation_.particles();
    account.count = particles.size();
    for (std::size_t i = 0; i < particles.size(); ++i) {
        account.mass += particles.mass[i];
        account.momentum += particles.mass[i] * particles.velocity[i];
    }
    account.energy = simulation_.kinetic_energy() + simulation_.potential_energy().value_or(0.0);
    return account;
}

Vec3 BookedRun::walls() const {
    Vec3 sum;
    for (const Vec3& impulse : simulation_.triangle_totals(0).impulse) sum += impulse;
    return sum;
}

/// An elastic wall leaves no particle at rest, so a particle at rest was absorbed.
void BookedRun::note_step() {
    for (const ContactRecord& contact : simulation_.contact_records()) {
        if (contact.velocity_after != Vec3{}) continue;
        ++swallowed_.count;
        swallowed_.mass += contact.mass;
        swallowed_.momentum += contact.mass * contact.velocity_before;
        swallowed_.energy += 0.5 * contact.mass * length_squared(contact.velocity_before);
    }
    for (const BirthRecord& birth : simulation_.birth_records()) {
        if (std::find(bearing_.begin(), bearing_.end(), birth.origin.emitter) == bearing_.end()) continue;
        ++born_.count;
        born_.mass += kChildMass;
    }
}

}  // namespace ricochet::test
