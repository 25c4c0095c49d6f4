#include "ricochet/response/response.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/advect.h"
#include "ricochet/response/exact.h"
#include "ricochet/response/impact_resolver.h"
#include "ricochet/response/penalty.h"
#include "ricochet/response/project.h"
#include "ricochet/response/rollback.h"
#include "ricochet/response/settings_table.h"

namespace ricochet {
namespace {

constexpr std::array kKinds{ResponseKind::exact, ResponseKind::rollback, ResponseKind::project, ResponseKind::penalty};
constexpr std::array<std::string_view, 4> kNames{"exact", "rollback", "project", "penalty"};  // in the order of kKinds

void require(const auto& settings, const auto& table, std::string_view owner) {
    const std::string refused = first_refusal(settings, table, owner);
    if (!refused.empty()) throw InputError(refused);
}

void check(const ResponseSettings& settings) {
    require(settings.rollback, kRollbackTable, "rollback.");
    require(settings.project, kProjectTable, "project.");
    require(settings.penalty, kPenaltyTable, "penalty.");
    require(settings.integrator.tolerance, kToleranceTable, "tolerance.");
}

/// Rejects adaptive methods if particles step together or in sub-steps, and implicit methods for sub-steps.
void check_integrator(ResponseKind kind, const ResponseSettings& settings) {
    const bool together = kind == ResponseKind::rollback && settings.rollback.global;
    const bool is_adaptive = settings.integrator.kind == IntegratorKind::dormand_prince;
    const bool is_implicit = settings.integrator.kind == IntegratorKind::implicit_euler;
    const bool has_substeps = kind == ResponseKind::penalty;
    if ((is_adaptive && (has_substeps || together)) || (is_implicit && has_substeps)) {
        throw InputError(fmt::format("integrator: found {} with {}; expected {}", name_of(settings.integrator.kind),
                                     together ? "rollback.global, where all particles step together"
                                              : "the penalty response, which steps in equal explicit sub-steps",
                                     together ? "a method of fixed steps, for example rk4"
                                              : "an explicit method of fixed steps, for example rk4"));
    }
}

/// Checks the rules of first-order motion, which has its own integrators, only one response, and no forces.
void check_flow(ResponseKind kind, const ResponseRules& rules) {
    if (kind != ResponseKind::exact) {
        throw InputError(
            fmt::format("response: found {}, expected exact: a flow carries the particles", name_of(kind)));
    }
    if (!rules.forces.empty()) {
        throw InputError(
            "forces: found some, expected none: a flow carries the particles, and forces would do nothing");
    }
    const IntegratorKind integrator = rules.settings.integrator.kind;
    if (carries_along_flows(integrator)) return;
    throw InputError(
        fmt::format("integrator: found {}, which has no meaning where a flow carries the particles; "
                    "expected forward_euler, midpoint, rk4 or dormand_prince",
                    name_of(integrator)));
}

}  // namespace

void MoveLists::clear() {
    hits.clear(), records.clear(), segments.clear(), motions.clear(), impacts.clear(), loads.clear();
}

void MoveLists::take(MoveLists& others) {
    std::swap(*this, others);
    others.clear();
}

void MoveLists::append(const MoveLists& more) {
    const auto append_to = [](auto& list, const auto& others) {
        list.insert(list.end(), others.begin(), others.end());
    };
    append_to(hits, more.hits);
    append_to(records, more.records);
    append_to(segments, more.segments);
    append_to(motions, more.motions);
    append_to(impacts, more.impacts);
    append_to(loads, more.loads);
}

void MoveOutcome::add(const MoveOutcome& next) {
    const MoveOutcome before = std::exchange(*this, next);
    bounces += before.bounces;
    touches += before.touches;
    unsimulated_time += before.unsimulated_time;
    stayed += before.stayed;
    squeezed = std::max(squeezed, before.squeezed);
    trials += before.trials;
}

std::optional<ResponseKind> response_from_name(std::string_view name) {
    const auto found = std::ranges::find(kNames, name);
    if (found == kNames.end()) return std::nullopt;
    return kKinds[static_cast<std::size_t>(found - kNames.begin())];
}

std::string_view name_of(ResponseKind kind) {
    const auto k = static_cast<std::size_t>(kind);
    return k < kNames.size() ? kNames[k] : std::string_view();
}

std::span<const ResponseKind> response_kinds() { return kKinds; }

SupportedAcceleration Response::supported_acceleration(const MovingParticle& /*particle*/, const Vec3& pull) const {
    return {pull};
}

void Response::apply_correction(MovingParticle& particle, const Vec3& change, double duration,
                                MoveScratch& scratch) const {
    MoveOutcome outcome;
    ImpactResolver impact(rules_, particle, scratch, outcome);
    Vec3 corrections = change;
    if (particle.contact.count > 0 && rules_.bodies.body_of(particle.contact.surfaces[0]) != kWorldBody) {
        // The particle moves with its body, so the body receives the correction.
        impact.ledger().record_impulse(particle.contact.surfaces[0], -corrections, false, Vec3{});
        impact.ledger().close();
        return;
    }
    const Vec3 pull = rules_.forces.acceleration(particle.state);
    const SupportedAcceleration before = supported_acceleration(particle, pull);
    const SupportedAcceleration after = supported_acceleration(particle, pull + change / duration);
    if (after.count > 0) {
        const Vec3 kept = duration * (after.acceleration - before.acceleration);
        const Vec3 by_surfaces = kept - change;
        // Records the increase of each reaction. The first surface also gets the rounding error.
        Vec3 left = by_surfaces;
        for (std::size_t k = 1; k < after.count; ++k) {
            Vec3 given = duration * after.reaction[k];
            for (std::size_t j = 0; j < before.count; ++j) {
                if (before.surfaces[j] == after.surfaces[k]) given -= duration * before.reaction[j];
            }
            left -= given;
            impact.ledger().record_impulse(after.surfaces[k], given, false, Vec3{});
        }
        impact.ledger().record_impulse(after.surfaces[0], left, false, Vec3{});
        particle.spin += duration * (after.spin_acceleration - before.spin_acceleration);
        corrections = kept;
    }
    particle.state.velocity += corrections;
    impact.ledger().close();
}

void Response::add_weight(const MovingParticle& /*particle*/, double /*duration*/,
                          std::vector<SurfaceHit>& /*hits*/) const {}

void Response::first_sides(const Vec3& /*position*/, std::span<SideMemory> sides) const {
    std::ranges::fill(sides, SideMemory{});
}

void Response::inherit_sides(const ChildStart& /*start*/, std::span<SideMemory> /*sides*/) const {}

Flight first_flight(const ResponseRules& rules, const MovingParticle& particle, double duration,
                    const Integrator& integrator) {
    const ForceInput& state = particle.state;
    if (particle.planned != nullptr) {
        const Flight& plan = *particle.planned;
        const bool untouched = state.position == plan.start.position && state.velocity == plan.start.velocity;
        if (untouched && duration == plan.path.duration) return plan;
    }
    return begin_flight(integrator, rules.forces, state, duration);
}

std::unique_ptr<Response> make_response(ResponseKind kind, const ResponseRules& rules) {
    check(rules.settings);
    check_integrator(kind, rules.settings);
    if (rules.settings.flow) {
        check_flow(kind, rules);
        return std::make_unique<AdvectResponse>(rules);
    }
    switch (kind) {
        case ResponseKind::rollback:
            return std::make_unique<RollbackResponse>(rules);
        case ResponseKind::project:
            return std::make_unique<ProjectResponse>(rules);
        case ResponseKind::penalty:
            return std::make_unique<PenaltyResponse>(rules);
        case ResponseKind::exact:
            break;
    }
    return std::make_unique<ExactResponse>(rules);
}

}  // namespace ricochet
