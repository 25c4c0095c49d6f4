#include "ricochet/simulation/start_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "ricochet/dynamics/emitter.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/implicit_euler.h"
#include "ricochet/dynamics/springs.h"
#include "ricochet/dynamics/stability.h"

namespace ricochet {
namespace {

/// Stiffness of a sphere's twelve neighbours in the closest packing, divided by that of one: the sum of the squared
/// cosines of the angles between the directions to them and any line. A mathematical constant.
constexpr double kClosestPacking = 4.0;

/// Number of decimal digits that distinguishes any two different doubles.
constexpr int kMostDigits = 17;

/// Returns true if methods that kick first are allowed. They would kick colliding spheres among moving colliders twice.
bool may_kick_first(const SimulationSetup& setup) {
    return !setup.options.particle_contacts || std::ranges::none_of(setup.colliders, [](const ColliderDescription& c) {
        return !c.frame.empty() || is_deforming(c);
    });
}

bool acts_on_all(const ParticlesForceEntry& entry) { return entry.particles.empty() && entry.emitters.empty(); }

bool acts_on_emitter(const ParticlesForceEntry& entry, std::size_t emitter) {
    const auto& emitters = entry.emitters;
    return acts_on_all(entry) || std::ranges::find(emitters, emitter) != emitters.end();
}

/// The two smallest masses of the particles between which a force acts, in kg; infinite if pinned or missing.
struct LightestPair {
    std::array<double, 2> masses{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    double count = 0.0;  ///< number of these particles

    void add(double mass) {
        masses[1] = std::min(masses[1], std::max(masses[0], mass));
        masses[0] = std::min(masses[0], mass);
        ++count;
    }
    /// Returns the inverse of the reduced mass, in 1/kg.
    [[nodiscard]] double reduced_inverse() const { return 1.0 / masses[0] + 1.0 / masses[1]; }
};

/// Returns the two smallest masses of a force's particles, without fragments, whose masses are not known yet.
LightestPair lightest_of(const SimulationSetup& setup, const ParticlesForceEntry& entry) {
    LightestPair lightest;
    const auto add = [&](const Particle& particle) {
        lightest.add(particle.pinned ? std::numeric_limits<double>::infinity() : particle.mass);
    };
    if (acts_on_all(entry)) std::ranges::for_each(setup.particles, add);
    for (const std::uint64_t id : entry.particles) {
        if (id < setup.particles.size()) add(setup.particles[id]);
    }
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        const EmitterDescription& emitter = setup.emitters[k];
        if (!acts_on_emitter(entry, k) || (emitter.parent && emitter.parent->share)) continue;
        const double mass = least_mass(emitter);
        lightest.add(mass);
        lightest.add(mass);
        lightest.count = std::numeric_limits<double>::infinity();
    }
    return lightest;
}

/// Returns both numbers as texts with the smallest number of digits that distinguishes them.
std::array<std::string, 2> told_apart(double step, double bound) {
    for (int digits = 3;; ++digits) {
        std::array<std::string, 2> texts{fmt::format("{:.{}g}", step, digits), fmt::format("{:.{}g}", bound, digits)};
        if (texts[0] != texts[1] || digits == kMostDigits) return texts;
    }
}

std::string too_long(const SimulationSetup& setup, double bound, const std::string& forces, const char* advice) {
    const auto [step, longest] = told_apart(setup.options.time_step, bound);
    return fmt::format(
        "the time step of {} s exceeds {} s, up to which {} is sure to be stable with {}: they may explode; use a "
        "shorter step or {}",
        step, longest, name_of(setup.options.integrator.kind), forces, advice);
}

std::string undamped(const SimulationSetup& setup, const std::string& forces, const char* whose) {
    const bool is_implicit = may_be_implicit(setup);
    std::string others = is_implicit ? "velocity_verlet or implicit_euler" : "velocity_verlet";
    if (may_kick_first(setup)) others = (is_implicit ? "symplectic_euler, " : "symplectic_euler or ") + others;
    return fmt::format(
        "{} is not stable at any time step with {}: they may explode; give {} damping of more than the time step times "
        "its stiffness, or use the integrator {}",
        name_of(setup.options.integrator.kind), forces, whose, others);
}

/// Largest relative growth of an energy in a run without a warning. Local: it decides only about a warning.
constexpr double kLargestGain = 0.01;

/// Returns a warning if the steps are short enough for stability, but the integrator still adds energy to the fastest
/// oscillation, as midpoint does unless dampers remove more. For slower ones, the added energy decreases with the
/// fourth power of the rate, and the damping only with the square.
std::optional<std::string> growth_warning(const SimulationSetup& setup, const OscillationRates& rates,
                                          const std::string& forces) {
    const double h = setup.options.time_step;
    const double damping = std::isfinite(rates.least_damper) ? rates.least_damper * rates.omega_squared : 0.0;
    const double factor = energy_factor(setup.options.integrator.kind, rates.omega_squared, damping, h);
    const double gain = std::pow(factor, setup.options.duration / h) - 1.0;
    if (!(gain > kLargestGain)) return std::nullopt;
    return fmt::format(
        "the integrator {} does not keep the energy of {}: the fastest oscillation may gain {:.2g} times its energy in "
        "{:.4g} s; use the integrator velocity_verlet, a shorter time_step or more damping",
        name_of(setup.options.integrator.kind), forces, gain, setup.options.duration);
}

std::optional<std::string> spring_warning(const SimulationSetup& setup) {
    const double bound = longest_stable_step(setup.options.integrator.kind, setup.springs, setup.particles);
    if (setup.options.time_step <= bound) {
        return growth_warning(setup, rates_of(setup.springs, setup.particles), "these springs");
    }
    if (bound == 0.0) return undamped(setup, "these springs, some of which have no damping", "every spring");
    return too_long(setup, bound, "these springs",
                    may_be_implicit(setup) ? "the integrator implicit_euler" : "softer springs and dampers");
}

/// Returns a warning if particles start nearer to each other than at rest, and need a shorter step at first.
std::optional<std::string> start_warning(const SimulationSetup& setup, std::size_t number, double bound_later) {
    // The packing of a setup can differ from the closest one by rounding. Local: it decides only about a warning.
    constexpr double kRounding = 1.0 - 1e-6;
    const OscillationRates rates = rates_at_start(setup, setup.particles_forces[number]);
    const double bound = longest_stable_step(setup.options.integrator.kind, rates);
    if (!(bound < kRounding * bound_later) || setup.options.time_step <= bound) return std::nullopt;
    const auto [step, longest] = told_apart(setup.options.time_step, bound);
    return fmt::format(
        "the time step of {} s exceeds {} s, up to which {} is sure to be stable with particle_forces[{}] while "
        "particles are as near to each other as at the start: they may explode; place them farther apart, or use a "
        "shorter step",
        step, longest, name_of(setup.options.integrator.kind), number);
}

std::optional<std::string> pair_warning(const SimulationSetup& setup, std::size_t number) {
    const ParticlesForceEntry& entry = setup.particles_forces[number];
    const std::optional<PairSteepness> steepness = steepness_of(*entry.force);
    const LightestPair lightest = lightest_of(setup, entry);
    if (!steepness || lightest.count < 2.0) return std::nullopt;
    const double neighbours = std::min(lightest.count - 1.0, kClosestPacking) * lightest.reduced_inverse();
    OscillationRates rates{neighbours * steepness->stiffness, neighbours * steepness->damping};
    if (steepness->stiffness > 0.0) rates.least_damper = steepness->damping / steepness->stiffness;
    const double bound = longest_stable_step(setup.options.integrator.kind, rates);
    if (auto warning = start_warning(setup, number, bound)) return warning;
    std::string what = fmt::format("particle_forces[{}] (stiffness {:.3g} N/m, ", number, steepness->stiffness);
    if (steepness->damping > 0.0) what += fmt::format("damping {:.3g} N s/m, ", steepness->damping);
    what += fmt::format("lightest particle {:.3g} kg)", lightest.masses[0]);
    if (setup.options.time_step <= bound) return growth_warning(setup, rates, what);
    if (rates.least_damper == 0.0 && setup.options.integrator.kind == IntegratorKind::forward_euler) {
        return undamped(setup, what + ", which has no damping", "it");
    }
    return too_long(setup, bound, "what is held together by " + what, "a weaker force");
}

/// A particle for which drag may be too strong, and its name in the scene.
struct DraggedParticle {
    ForceInput state{};
    std::string name;
};

/// Returns the particles of an emitter that drag affects most: the lightest, largest and fastest particle in each
/// possible direction. With a density, the lightest particle is the smallest one. Returns nothing for clouds, and for
/// fragments, whose masses are known only during the run.
std::vector<DraggedParticle> most_dragged_of(const EmitterDescription& emitter, std::size_t number) {
    const double lightest = least_mass(emitter);
    if (!(lightest > 0.0) || is_cloud(emitter) || (emitter.parent && emitter.parent->share)) return {};
    const bool has_any_path = length_squared(emitter.direction) == 0.0;
    std::vector<Vec3> headings{emitter.direction};
    if (has_any_path) headings = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    const double speed = most_speed(emitter);
    std::vector<DraggedParticle> particles;
    for (const Vec3& heading : headings) {
        Particle particle;
        particle.position = bounds(emitter.shape).center();
        particle.velocity = emitter.velocity + (speed / length(heading)) * heading;
        particle.mass = lightest;
        particle.radius = emitter.density ? emitter.radius.least() : emitter.radius.most();
        particle.birth_time = emitter.start;
        if (emitter.frames) particle = launched_from(*emitter.frames, emitter.frame, particle);
        const ForceInput state{particle.position, particle.velocity,   particle.mass,
                               particle.radius,   particle.birth_time, std::numeric_limits<std::uint64_t>::max()};
        particles.push_back({state, "particles of " + named(emitter.name, "emitters", number)});
    }
    return particles;
}

/// Returns the velocity, in m/s, of the particle after a long time under drag and the common acceleration. The time is
/// limited to kManySteps steps, because drag that needs more time is weak.
Vec3 falling_velocity(const std::vector<const Force*>& drags, const Vec3& pull, const ForceInput& state, double step) {
    // Local, because it decides only about a warning.
    constexpr double kManySteps = 1000.0;
    const auto sum = [&](const ForceInput& input) {
        ForceInput here = state;
        here.velocity = input.velocity;
        Vec3 acceleration = pull;
        for (const Force* const drag : drags) acceleration += drag->acceleration(here);
        return acceleration;
    };
    std::vector<std::unique_ptr<Force>> forces;
    forces.push_back(make_acceleration(sum));
    return implicit_euler_velocity(ForceField(std::move(forces)), state, kManySteps * step);
}

/// The particle that drag damps fastest, at its initial velocity or the velocity of its fall.
class FastestDamped {
public:
    FastestDamped(const SimulationSetup& setup, std::vector<const Force*> drags)
        : drags_(std::move(drags)), step_(setup.options.time_step) {
        for (const auto& force : setup.forces) pull_ += force->common_acceleration().value_or(Vec3{});
        for (std::size_t i = 0; i < setup.particles.size(); ++i) {
            const Particle& p = setup.particles[i];
            if (!p.pinned)
                take({p.position, p.velocity, p.mass, p.radius, 0.0, i},
                     [&] { return fmt::format("particles[{}]", i); });
        }
        for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
            for (const DraggedParticle& p : most_dragged_of(setup.emitters[k], k))
                take(p.state, [&] { return p.name; });
        }
    }
    [[nodiscard]] double rate() const { return rate_; }
    [[nodiscard]] const DraggedParticle& particle() const { return particle_; }

private:
    template <class Name>
    void take(ForceInput state, const Name& name) {
        compare(state, name);
        if (state.mass == fallen_.mass && state.radius == fallen_.radius) return;  // falls like the previous particle
        fallen_ = state;
        state.velocity = falling_velocity(drags_, pull_, state, step_);
        compare(state, name);
    }
    template <class Name>
    void compare(const ForceInput& state, const Name& name) {
        double rate = 0.0;
        for (const Force* const drag : drags_) rate += damping_rate(*drag, state);
        if (rate <= rate_) return;
        rate_ = rate;
        particle_ = {state, name()};
    }

    std::vector<const Force*> drags_;
    double step_;
    Vec3 pull_;
    double rate_ = 0.0;
    ForceInput fallen_{};
    DraggedParticle particle_;
};

std::optional<std::string> drag_warning(const SimulationSetup& setup) {
    std::vector<const Force*> drags;
    for (const auto& force : setup.forces) {
        if (force && is_drag(*force)) drags.push_back(force.get());
    }
    if (drags.empty() || setup.options.flow) return std::nullopt;
    const FastestDamped fastest(setup, drags);
    OscillationRates rates;
    rates.gamma = fastest.rate();
    const double bound = longest_stable_step(setup.options.integrator.kind, rates);
    if (setup.options.time_step <= bound) return std::nullopt;
    const auto [step, longest] = told_apart(setup.options.time_step, bound);
    const ForceInput& particle = fastest.particle().state;
    return fmt::format(
        "the time step of {} s exceeds {} s, up to which {} is sure to be stable with the drag on {} (mass "
        "{:.3g} kg, radius {:.3g} m, {:.3g} m/s): drag may throw them back, ever faster, instead of slowing them; use "
        "a "
        "time_step of at most {} s{}",
        step, longest, name_of(setup.options.integrator.kind), fastest.particle().name, particle.mass, particle.radius,
        length(particle.velocity), longest, may_be_implicit(setup) ? " or the integrator implicit_euler" : "");
}

/// Returns true if children overlap other particles at their births. Children start at the position of their parent.
/// Therefore two children of one event overlap each other, and a child overlaps a parent that lives on.
bool is_born_beside_others(const ParentRule& rule) {
    return (!rule.share && rule.on != BirthEvent::death) || rule.count.most() >= 1.5;
}

std::vector<std::string> birth_warnings(const SimulationSetup& setup) {
    std::vector<std::string> warnings;
    for (std::size_t k = 0; k < setup.particles_forces.size(); ++k) {
        const ParticlesForceEntry& entry = setup.particles_forces[k];
        if (!lacks_softening(*entry.force)) continue;
        for (std::size_t e = 0; e < setup.emitters.size(); ++e) {
            const EmitterDescription& emitter = setup.emitters[e];
            if (!acts_on_emitter(entry, e) || !emitter.parent || !is_born_beside_others(*emitter.parent)) continue;
            warnings.push_back(
                fmt::format("children of {} begin where their parent is, in each other, and particle_forces[{}], which "
                            "has no softening, may throw them apart at any speed: give it a softening of about their "
                            "radius, or leave them out of it",
                            named(emitter.name, "emitters", e), k));
        }
    }
    return warnings;
}

}  // namespace

bool may_be_implicit(const SimulationSetup& setup) {
    const SimulationOptions& options = setup.options;
    if (options.integrator.kind == IntegratorKind::implicit_euler) return false;
    if (options.flow || options.response == ResponseKind::penalty) return false;
    if (!setup.particles_forces.empty() && !setup.solver) return false;
    return !options.particle_contacts || (setup.springs.empty() && may_kick_first(setup));
}

std::vector<std::string> stability_warnings(const SimulationSetup& setup) {
    std::vector<std::string> warnings;
    if (setup.solver) return warnings;
    if (auto warning = drag_warning(setup)) warnings.push_back(std::move(*warning));
    if (auto warning = spring_warning(setup)) warnings.push_back(std::move(*warning));
    for (std::size_t k = 0; k < setup.particles_forces.size(); ++k) {
        if (auto warning = pair_warning(setup, k)) warnings.push_back(std::move(*warning));
    }
    for (std::string& warning : birth_warnings(setup)) warnings.push_back(std::move(warning));
    for (std::string& warning : energy_warnings(setup)) warnings.push_back(std::move(warning));
    return warnings;
}

}  // namespace ricochet
