#include <cstdint>
#include <string_view>
#include <utility>

#include "fuzz/fuzz_targets.h"
#include "fuzz/tiny_scene.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"

namespace ricochet::fuzz {
namespace {

/// How a scene is run.
struct Variant {
    bool verify = false;
    bool at_once = false;  ///< by advance()
    AccelerationSwitches acceleration{};
};

/// A second way to run it that must come to the same bits.
Variant other_way(std::uint8_t choice) {
    Variant other;
    other.at_once = (choice & 1U) != 0;
    other.acceleration.sleeping = (choice & 2U) == 0;
    other.acceleration.look_ahead = (choice & 4U) == 0;
    other.acceleration.spatial_order = (choice & 8U) == 0;
    other.acceleration.culling = (choice & 16U) == 0;
    return other;
}

void require_sound(const Simulation& simulation) {
    const Particles& particles = simulation.particles();
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const bool is_known = is_finite(particles.position[i]) && is_finite(particles.velocity[i]);
        require(is_known || particles.frozen[i] != 0, "a particle that moves is somewhere");
    }
    // The other two let particles pass walls that are thin for their step, by design.
    const ResponseKind response = simulation.options().response;
    if (response != ResponseKind::exact && response != ResponseKind::rollback) return;
    require(simulation.statistics().violations == 0, "no segment crosses a surface, no sphere overlaps one");
}

/// Hash of the end; 0 where springs gain energy without bound, which ends a run.
std::uint64_t end_of(ByteChoices choices, const Variant& variant) {
    SimulationSetup setup = tiny_scene(choices);
    setup.options.verify = variant.verify;
    setup.acceleration = variant.acceleration;
    Simulation simulation(std::move(setup));
    try {
        while (!simulation.finished()) {
            simulation.advance(variant.at_once ? kTinySteps : 1);
        }
    } catch (const DivergedError&) {
        return 0;
    }
    require_sound(simulation);
    return simulation.state_hash();
}

}  // namespace

// The first byte says how it is run the second time, the others choose the scene.
bool fuzz_run(std::string_view bytes) {
    static const ThreadLimit one_thread(1);
    ByteChoices choices(bytes);
    const Variant other = other_way(choices.byte());
    std::uint64_t end = 0;
    try {
        end = end_of(choices, {.verify = true});
    } catch (const InputError&) {
        return false;
    }
    require(end == end_of(choices, other), "accelerations change no bit");
    return true;
}

}  // namespace ricochet::fuzz
