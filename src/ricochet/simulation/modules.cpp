#include "ricochet/simulation/modules.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/cloud_motion.h"
#include "ricochet/simulation/counters/counter_tally.h"
#include "ricochet/simulation/heat_stage.h"
#include "ricochet/simulation/pair_motion.h"
#include "ricochet/simulation/retirement.h"
#include "ricochet/simulation/run_check.h"
#include "ricochet/verify/sphere_overlaps.h"

namespace ricochet {
namespace {

/// Wakes sleeping particles near moving colliders. The supports of all others are at rest.
class WakingModule final : public Module {
public:
    WakingModule(const MovingColliders& moving, const ModuleParts& parts) : moving_(moving), parts_(parts) {}

    void before_substep(const ParticleRange& /*generation*/, const TimeSpan& substep) override {
        const ParticleStore& store = parts_.population.store();
        for (std::size_t i = 0; store.may_sleep() && i < store.size(); ++i) {
            const bool sleeps = store.is_asleep(i) && !store.is_fixed(i);
            if (!sleeps || !parts_.population.schedule().is_left_alone(i) || !is_near_moving(i)) continue;
            parts_.recorder.statistics().lost_impulses += parts_.mover.add_weight(i, substep.begin, 1.0);
            parts_.population.wake(i);
        }
    }
    [[nodiscard]] bool allows_deferred_steps() const override { return true; }

private:
    [[nodiscard]] bool is_near_moving(std::size_t i) const {
        const Vec3& position = parts_.population.particles().position[i];
        const double radius = parts_.population.particles().radius[i];
        const double reach = radius + kWakingReach * (radius + max_abs(position)) + kSmallestContactOffset;
        const Vec3 by{reach, reach, reach};
        return !moving_.all_stay_out({position - by, position + by});
    }

    const MovingColliders& moving_;
    ModuleParts parts_;
};

/// Checks every step with independent code.
class VerificationModule final : public Module {
public:
    explicit VerificationModule(const ModuleParts& parts)
        : parts_(parts), check_(parts.scene.world(), parts.scene.moving()) {}

    [[nodiscard]] MoveParts needs() const override { return {.segments = true, .motions = true}; }
    void observe(const MoveReport& move, BlockRecord& block) override { check_.check(move, block.violations); }

    void verify(const TimeSpan& step) override {
        if (parts_.options.particle_contacts) verify_spheres(step);
        if (parts_.recorder.statistics().steps + 1 < parts_.clock.steps()) return;
        parts_.recorder.add_violations(check_.check_end(parts_.population.particles(), step.end));
    }
    void compact(const std::vector<std::uint8_t>& keep) override { check_.compact(keep); }
    void bind() override { check_.add_spawned(parts_.population.size()); }
    void restart(double time) override { check_.restart(parts_.population.store(), time); }

private:
    void verify_spheres(const TimeSpan& step) {
        const bool may_plan = parts_.options.particle_contacts->method != PairMethod::events;
        const double most = may_plan ? kMostPlannedOverlap : kMostMetOverlap;
        parts_.recorder.add_pair_violations(check_.check_spheres(parts_.population.particles(), step, most));
        SimulationStatistics& statistics = parts_.recorder.statistics();
        statistics.overlap_verified = std::max(statistics.overlap_verified, check_.largest_overlap());
    }

    ModuleParts parts_;
    RunCheck check_;
};

/// Returns the module, or null if no emitter has a parent.
std::unique_ptr<ChildrenModule> make_children(const ModuleParts& parts) {
    const bool has_children =
        std::ranges::any_of(parts.emitters, [](const Emitter& e) { return e.description().parent.has_value(); });
    return has_children ? std::make_unique<ChildrenModule>(parts) : nullptr;
}

/// Returns the module, or null if temperatures do not change.
std::unique_ptr<HeatStage> make_heat(std::optional<HeatSettings>& heat, const ModuleParts& parts) {
    if (!heat) return nullptr;
    return std::make_unique<HeatStage>(std::move(*heat), parts.population.store(), parts.response.rules().forces,
                                       parts.scene.moving());
}

/// Returns the module, or null without clouds.
std::unique_ptr<CloudMotion> make_clouds(const ModuleParts& parts, const Retirement& retirement,
                                         ChildrenModule* children) {
    if (std::ranges::none_of(parts.emitters, [](const Emitter& e) { return is_cloud(e.description()); })) {
        return nullptr;
    }
    auto clouds = std::make_unique<CloudMotion>(parts.emitters, parts.population.store(), parts.mover, retirement);
    parts.hooks.clouds = clouds.get();
    children->set_clouds(*clouds);
    return clouds;
}

/// Returns the module, or null if spheres pass through each other.
std::unique_ptr<PairMotion> make_pairs(const ModuleParts& parts, SpringsModule& springs) {
    if (!parts.options.particle_contacts) return nullptr;
    const PairContactSettings& settings = *parts.options.particle_contacts;
    ParticleStore& store = parts.population.store();
    PairParts of_pairs{store,    parts.population.schedule(), parts.mover, parts.response, springs.motion(),
                       settings, PairMaterials(settings)};
    if (!settings.materials.empty()) of_pairs.material_column = store.particles().attributes.find(kMaterialAttribute);
    auto pairs = std::make_unique<PairMotion>(of_pairs, parts.recorder, parts.options.verify);
    parts.hooks.sleeping_islands = &pairs->sleeping_islands();
    springs.set_pairs(*pairs);
    return pairs;
}

/// Returns the module, or null without counters.
std::unique_ptr<CounterTally> make_counters(const SimulationSetup& setup, const ModuleParts& parts) {
    if (setup.counters.empty()) return nullptr;
    return std::make_unique<CounterTally>(setup.counters, parts.options.response == ResponseKind::exact);
}

}  // namespace

void add_modules(ModuleList& modules, SimulationSetup& setup, const ModuleParts& parts) {
    const auto add = [&](std::unique_ptr<Module> module) {
        if (module) modules.add(std::move(module));
    };
    auto children = make_children(parts);
    auto springs = std::make_unique<SpringsModule>(setup, parts);
    auto retirement = std::make_unique<Retirement>(setup.bounds, parts.population, parts.mover, parts.recorder);
    auto clouds = make_clouds(parts, *retirement, children.get());
    auto pairs = make_pairs(parts, *springs);
    const MovingColliders& moving = parts.scene.moving();
    add(std::move(children));
    add(make_heat(setup.heat, parts));
    add(moving.empty() ? nullptr : std::make_unique<WakingModule>(moving, parts));
    add(std::move(clouds));
    add(std::move(springs));
    add(std::move(pairs));
    add(std::make_unique<BodiesModule>(std::move(setup.bodies), parts));
    add(std::move(retirement));
    add(parts.options.verify ? std::make_unique<VerificationModule>(parts) : nullptr);
    add(make_counters(setup, parts));
    add(parts.share.is_alone() ? nullptr : std::make_unique<SharedRun>(parts));
    add(make_runaways(parts));
}

}  // namespace ricochet
