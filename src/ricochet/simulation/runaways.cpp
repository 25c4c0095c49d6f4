// Ends a run in which a particle exceeds the speed of light.
#include <fmt/format.h>

#include <optional>
#include <string>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {

/// Returns the impulses without which the particle would be slower than light, if there are any. Surfaces at rest give
/// no speed, unless the response has springs, which can diverge.
RunawayCause ActiveMover::runaway_cause(std::size_t i, const MoveImpulses& impulses) const {
    const Particles& particles = parts_.store.particles();
    const auto is_slow_without = [&](const Vec3& given) { return length(particles.velocity[i] - given) <= kMaxSpeed; };
    const Vec3 by_surfaces = (impulse_of(impulses.hits) + impulses.by_surfaces) / particles.mass[i];
    const bool may_throw = parts_.recorder.collects_loads() || parts_.response.keeps_sides();
    if (may_throw && is_slow_without(by_surfaces)) return RunawayCause::surface;
    if (is_slow_without(impulses.by_spheres) || is_slow_without(impulses.by_spheres + by_surfaces)) {
        return RunawayCause::spheres;
    }
    return parts_.coupled.holds(i) ? RunawayCause::others : RunawayCause::forces;
}

// If ranks share the run, all of them end in the same step, with the same message as a single process.
void Simulation::Impl::stop_runaways(const std::vector<BlockRecord>& blocks, double time) const {
    const std::optional<Runaway> runaway = first_runaway(blocks);
    if (!runaway && share.is_alone()) return;
    std::optional<std::string> message;
    if (runaway) message = runaway_message(*runaway, time);
    if (!share.is_alone()) message = share.first_message(message, runaway ? particles().id[runaway->particle] : 0);
    if (message) throw DivergedError(*message);
}

std::string Simulation::Impl::runaway_message(const Runaway& runaway, double time) const {
    const auto told = [&](const char* cause, const char* verb, const std::string& advice) {
        return fmt::format("by t = {:.6g} s {} {} {} {:.3g} m/s, beyond the speed of light{}", time, cause,
                           particles().id[runaway.particle], verb, runaway.speed, advice);
    };
    if (runaway.cause == RunawayCause::surface && recorder.collects_loads()) {
        return told("a surface has thrown particle", "at", ": let the colliders, or their materials, move more slowly");
    }
    if (runaway.cause == RunawayCause::surface) {
        return told("a contact has thrown particle", "at",
                    ": the penalty response has diverged; use a shorter time step, more substeps or softer contacts");
    }
    const bool is_alone = runaway.cause == RunawayCause::forces;
    if (!is_alone && faster_than_light) {
        return told(
            "particle", "has come to",
            fmt::format(", and particle {} has set out at {:.3g} m/s: let no particle set out faster than light",
                        faster_than_light->first, faster_than_light->second));
    }
    if (runaway.cause == RunawayCause::spheres) {
        return told("another sphere has thrown particle", "at",
                    ": use a shorter time step, slower spheres or weaker forces");
    }
    // A method that chooses its own steps has found no step that is short enough.
    const bool is_adaptive = options.integrator.kind == IntegratorKind::dormand_prince;
    const std::string advice = fmt::format(": the motion has diverged; use {}{}or weaker forces",
                                           is_adaptive ? "softening, " : "a shorter time step, ",
                                           knows_implicit ? "the integrator implicit_euler, " : "");
    return is_alone ? told("forces have brought particle", "to", advice)
                    : told("springs or forces between particles have brought particle", "to", advice);
}

}  // namespace ricochet
