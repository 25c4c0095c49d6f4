// Estimates the memory that a scene needs, before a run allocates it.
#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "ricochet/core/memory_limit.h"
#include "ricochet/io/scene/context.h"
#include "ricochet/simulation/memory_estimate.h"

namespace ricochet::detail {
namespace {

std::string_view births_key(const ObjectView& view, const EmitterDescription& emitter, std::uint64_t population) {
    if (2 * emitter.burst >= population) return "burst";
    for (const std::string_view key : {"rate_per_frame", "rate_per_area"}) {
        if (view.has(key)) return key;
    }
    return "rate";
}

void refuse(const SceneContext& context, const SceneDescription& scene, const MemoryNeed& need,
            const MemoryLimit& limit) {
    const auto error = [&](const ObjectView& view, std::string_view key, std::string_view what) {
        context.error(
            view, key,
            fmt::format("with {} {} the scene {}", need.count, what, too_much_memory(scene.memory_bytes, limit)));
    };
    switch (need.part) {
        case MemoryNeed::Part::particles:
            return error(context.root(), "particles", "particles");
        case MemoryNeed::Part::springs:
            return error(context.root(), "springs", "springs");
        case MemoryNeed::Part::emitter: {
            const ObjectView view = context.objects("emitters")[need.number];
            return error(view, births_key(view, scene.setup.emitters[need.number], need.count),
                         "particles alive at a time");
        }
        case MemoryNeed::Part::collider:
            return error(context.objects("colliders")[need.number], "file", "triangles");
        case MemoryNeed::Part::contacts:
            return error(context.root().object("output"), "contacts", "contacts to be written");
    }
}

void warn_of_bursts(const SceneContext& context, const SimulationSetup& setup) {
    const std::uint64_t most = setup.options.most_particles;
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        if (setup.emitters[k].burst <= most) continue;
        context.warn(context.objects("emitters")[k], "burst",
                     fmt::format("found {}, more than the {} of simulation.most_particles: the others are not born",
                                 setup.emitters[k].burst, most));
    }
}

}  // namespace

void check_memory(const SceneContext& context, SceneDescription& scene) {
    if (context.failed()) return;
    warn_of_bursts(context, scene.setup);
    const MemoryEstimate estimate = estimate_memory(scene.setup);
    scene.memory_bytes = estimate.bytes() + context.memory_bytes();
    const MemoryLimit limit = memory_limit();
    if (!estimate.needs.empty() && estimate.bytes_to_come() > limit.bytes) {
        refuse(context, scene, estimate.largest(), limit);
    }
}

}  // namespace ricochet::detail
