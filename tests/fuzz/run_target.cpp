#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <variant>

#include "fuzz/fuzz_targets.h"
#include "fuzz/tiny_scene.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"

namespace ricochet::fuzz {
namespace {

/// Settings of a run.
struct Variant {
    bool verify = false;
    bool at_once = false;  ///< one call of advance()
    AccelerationSwitches acceleration{};
};

/// Returns two variants that must give the same bits. Each acceleration is on in at least one of them.
std::array<Variant, 2> two_ways(std::uint8_t choice) {
    const auto bit = [&](unsigned k) { return (choice >> k & 1U) != 0; };
    const AccelerationSwitches first{
        .look_ahead = bit(0), .sleeping = bit(1), .spatial_order = bit(2), .culling = true};
    const AccelerationSwitches second{
        .look_ahead = bit(3) || !bit(0), .sleeping = bit(4) || !bit(1), .spatial_order = true, .culling = bit(5)};
    return {Variant{.verify = true, .at_once = false, .acceleration = first},
            Variant{.verify = false, .at_once = bit(6), .acceleration = second}};
}

/// Returns true if the scene has a round shape. A sphere can jam inside it at a point that is narrower than the sphere.
bool has_round_collider(const Simulation& simulation) {
    const auto& colliders = simulation.colliders();
    return std::any_of(colliders.begin(), colliders.end(), [](const ColliderDescription& collider) {
        return std::holds_alternative<BallShape>(collider.shape) ||
               std::holds_alternative<CylinderShape>(collider.shape);
    });
}

/// Throws a Finding if the state is invalid. is_uniform: all forces are constant in space and time. For other forces
/// the energy is only known within bounds.
void require_sound(const Simulation& simulation, bool is_uniform) {
    const Particles& particles = simulation.particles();
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const bool is_known = is_finite(particles.position[i]) && is_finite(particles.velocity[i]);
        require(is_known || particles.frozen[i] != 0, "a particle that moves is somewhere");
    }
    // The other two responses let particles pass thin walls by design.
    const ResponseKind response = simulation.options().response;
    if (response != ResponseKind::exact && response != ResponseKind::rollback) return;
    const bool may_jam = has_round_collider(simulation);
    for (const Violation& violation : simulation.violations()) {
        require(violation.kind != ViolationKind::crossing, "no segment crosses a surface");
        require(violation.kind != ViolationKind::gap, "segments join the positions");
        // Colliders may pass a stalled particle until the end of the run. The verifier must report that.
        const bool may_wait = simulation.statistics().unsimulated_time > 0.0 && violation.time >= simulation.time();
        require(violation.kind != ViolationKind::wrong_side || may_wait, "every particle stays on its side");
        require(violation.kind != ViolationKind::overlap || may_jam, "no sphere overlaps a surface");
        require(violation.kind != ViolationKind::energy || !is_uniform, "no energy comes from surfaces");
    }
}

/// Returns the hash of the final state, or 0 if springs gain energy without bound, which ends a run.
std::uint64_t end_of(ByteChoices choices, const Variant& variant) {
    SimulationSetup setup = tiny_scene(choices);
    setup.options.verify = variant.verify;
    setup.acceleration = variant.acceleration;
    const bool is_uniform = setup.springs.empty() && std::all_of(setup.forces.begin(), setup.forces.end(),
                                                                 [](const auto& force) { return force->is_uniform(); });
    Simulation simulation(std::move(setup));
    try {
        while (!simulation.finished()) {
            simulation.advance(variant.at_once ? kTinySteps : 1);
        }
    } catch (const DivergedError&) {
        return 0;
    }
    require_sound(simulation, is_uniform);
    return simulation.state_hash();
}

}  // namespace

// The first byte selects the variant and whether to run a second time. The others select the scene.
bool fuzz_run(std::string_view bytes) {
    static const ThreadLimit one_thread(1);
    ByteChoices choices(bytes);
    const std::uint8_t choice = choices.byte();
    const auto [first, second] = two_ways(choice);
    const bool runs_once = choice >= 128;
    try {
        const std::uint64_t end = end_of(choices, first);
        require(runs_once || end == end_of(choices, second), "accelerations change no bit");
    } catch (const InputError&) {
        return false;
    }
    return true;
}

}  // namespace ricochet::fuzz
