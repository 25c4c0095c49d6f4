// Ends a run in which a particle exceeds the speed of light.
#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/modules.h"

namespace ricochet {
namespace {

/// Throws DivergedError if a particle was accelerated beyond kMaxSpeed. It may be that fast at its birth.
class Runaways final : public Module {
public:
    explicit Runaways(const ModuleParts& parts) : parts_(parts) {}

    void before_generation(const ParticleRange& /*generation*/, const TimeSpan& step) override { step_end_ = step.end; }
    /// All ranks throw in the same step, with the message that a single process would give.
    void correct(const ParticleRange& /*generation*/, const TimeSpan& /*substep*/,
                 std::vector<BlockRecord>& blocks) override {
        const std::optional<Runaway> runaway = first_runaway(blocks);
        std::optional<std::string> message;
        if (runaway) message = message_of(*runaway);
        const std::uint64_t id = runaway ? parts_.population.particles().id[runaway->particle] : 0;
        message = parts_.share.first_message(message, id);
        if (message) throw DivergedError(*message);
    }
    void append() override { note_speed(parts_.population.size() - 1); }
    [[nodiscard]] bool allows_deferred_steps() const override { return true; }
    void archive(BinaryWriter& /*a*/) override {}
    /// A restored particle counts like a particle at its birth.
    void archive(BinaryReader& /*a*/) override {
        for (std::size_t i = 0; i < parts_.population.size(); ++i) note_speed(i);
    }

private:
    void note_speed(std::size_t i) {
        const Particles& particles = parts_.population.particles();
        const double speed = length(particles.velocity[i]);
        if (!faster_than_light_ && speed > kMaxSpeed) faster_than_light_ = {particles.id[i], speed};
    }
    [[nodiscard]] std::string message_of(const Runaway& runaway) const;

    ModuleParts parts_;
    double step_end_ = 0.0;  // s
    /// Id and speed, in m/s, of the first particle that was faster than light at its birth.
    std::optional<std::pair<std::uint64_t, double>> faster_than_light_;
};

std::string Runaways::message_of(const Runaway& runaway) const {
    const auto told = [&](const char* cause, const char* verb, const std::string& advice) {
        return fmt::format("by t = {:.6g} s {} {} {} {:.3g} m/s, beyond the speed of light{}", step_end_, cause,
                           parts_.population.particles().id[runaway.particle], verb, runaway.speed, advice);
    };
    if (runaway.cause == RunawayCause::surface && parts_.recorder.collects_loads()) {
        return told("a surface has thrown particle", "at", ": let the colliders, or their materials, move more slowly");
    }
    if (runaway.cause == RunawayCause::surface) {
        return told("a contact has thrown particle", "at",
                    ": the penalty response has diverged; use a shorter time step, more substeps or softer contacts");
    }
    const bool is_alone = runaway.cause == RunawayCause::forces;
    if (!is_alone && faster_than_light_) {
        return told(
            "particle", "has come to",
            fmt::format(", and particle {} has set out at {:.3g} m/s: let no particle set out faster than light",
                        faster_than_light_->first, faster_than_light_->second));
    }
    if (runaway.cause == RunawayCause::spheres) {
        return told("another sphere has thrown particle", "at",
                    ": use a shorter time step, slower spheres or weaker forces");
    }
    // An adaptive method has found no step that is short enough, so a shorter time step would not help.
    const bool is_adaptive = parts_.options.integrator.kind == IntegratorKind::dormand_prince;
    const std::string advice = fmt::format(": the motion has diverged; use {}{}or weaker forces",
                                           is_adaptive ? "softening, " : "a shorter time step, ",
                                           parts_.warnings.knows_implicit() ? "the integrator implicit_euler, " : "");
    return is_alone ? told("forces have brought particle", "to", advice)
                    : told("springs or forces between particles have brought particle", "to", advice);
}

}  // namespace

/// Returns the cause of a speed beyond kMaxSpeed. Impulses of surfaces or spheres are the cause if the particle would
/// be slower without them. Surfaces at rest cannot be the cause, unless the response has springs, which can diverge.
RunawayCause ActiveMover::runaway_cause(std::size_t i, const MoveImpulses& impulses) const {
    const Particles& particles = parts_.store.particles();
    const auto is_slow_without = [&](const Vec3& given) { return length(particles.velocity[i] - given) <= kMaxSpeed; };
    const Vec3 by_surfaces = (impulse_of(impulses.hits) + impulses.by_surfaces) / particles.mass[i];
    const bool may_throw = parts_.recorder.collects_loads() || response_.keeps_sides();
    if (may_throw && is_slow_without(by_surfaces)) return RunawayCause::surface;
    if (is_slow_without(impulses.by_spheres) || is_slow_without(impulses.by_spheres + by_surfaces)) {
        return RunawayCause::spheres;
    }
    return coupled().holds(i) ? RunawayCause::others : RunawayCause::forces;
}

std::unique_ptr<Module> make_runaways(const ModuleParts& parts) { return std::make_unique<Runaways>(parts); }

}  // namespace ricochet
