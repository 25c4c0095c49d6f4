// Particles that are there from the start.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/io/detail/attribute_keys.h"
#include "ricochet/io/detail/particle_table.h"
#include "ricochet/io/detail/scene_context.h"
#include "ricochet/io/detail/suggestion.h"

namespace ricochet::detail {
namespace {

// Columns for looks that only the table has are declared by it.
std::vector<Particle> particles_from_table(const SceneContext& context, const ObjectView& view,
                                           SimulationSetup& setup) {
    if (!view.has("file")) return {};
    try {
        ParticleTable table = read_particle_table(context.file_of(view), setup.attributes);
        for (const std::string& problem : table.errors) context.error(view, "file", problem);
        if (!table.unused_columns.empty()) {
            const std::vector<std::string_view> names(table.unused_columns.begin(), table.unused_columns.end());
            context.warn(view, "file",
                         fmt::format("the columns {} are not used: particles start with new ids and without a history",
                                     quoted_list(names)));
        }
        setup.attributes = std::move(table.attributes);
        return std::move(table.particles);
    } catch (const InputError& problem) {
        context.error(view, "file", problem.what());
        return {};
    }
}

void warn_about_particles_outside(const SceneContext& context, const SimulationSetup& setup) {
    if (!setup.bounds) return;
    const auto outside = std::count_if(setup.particles.begin(), setup.particles.end(),
                                       [&](const Particle& p) { return !setup.bounds->contains(p.position); });
    if (outside == 0) return;
    context.warn(
        context.root(), "particles",
        fmt::format("{} of {} start outside the bounds and are retired at once", outside, setup.particles.size()));
}

}  // namespace

void build_particles(SceneContext& context, SimulationSetup& setup) {
    const JsonNode& node = context.root().node("particles");
    if (node.object() != nullptr) {
        setup.particles = particles_from_table(context, ObjectView(node, particle_file_spec(), "particles"), setup);
    }
    for (const ObjectView& view : context.objects("particles")) {
        Particle particle;
        particle.position = view.vector("position");
        particle.velocity = view.vector("velocity");
        particle.mass = view.number("mass");
        particle.radius = view.number("radius");
        particle.spin = view.vector("spin");
        particle.attributes = particle_values(context, setup, view);
        particle.pinned = view.boolean("pinned");
        setup.particles.push_back(particle);
    }
    warn_about_particles_outside(context, setup);
}

}  // namespace ricochet::detail
