// Refuses parts of a setup that are valid by themselves but exclude each other.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/cloud.h"
#include "ricochet/simulation/validation.h"

namespace ricochet {
namespace {

/// Refuses moving wall materials in a flow. A particle in a flow has the flow's velocity and no friction.
void validate_flow_walls(const SimulationSetup& setup) {
    if (setup.options.flow == nullptr) return;
    for (std::size_t k = 0; k < setup.materials.size(); ++k) {
        if (!setup.materials[k].drives()) continue;
        Subject("material", k, setup.materials[k].name)
            .refuse("surface_motion", "a velocity", "none: walls do not carry particles in a flow");
    }
}

/// Validates forces between particles, and refuses parts that exclude them.
void validate_particles_forces(const SimulationSetup& setup) {
    for (std::size_t k = 0; k < setup.particles_forces.size(); ++k) {
        const ParticlesForceEntry& entry = setup.particles_forces[k];
        const std::string own_name = entry.force ? entry.force->name() : std::string();
        const Subject subject = own_name.empty() ? Subject("force between particles", k) : Subject(own_name);
        if (!entry.force) subject.refuse("force", "a null pointer", "a force");
        for (const std::uint32_t emitter : entry.emitters) {
            subject.require_index(emitter, setup.emitters.size(), "emitter", "emitters");
        }
        for (const std::string& name : entry.force->attributes()) {
            const auto has_name = [&](const AttributeDescription& column) { return column.name == name; };
            if (std::ranges::any_of(setup.attributes, has_name)) continue;
            subject.refuse("attribute", name, "the name of one of the setup's attributes");
        }
        if (setup.options.flow) subject.refuse("motion", "a flow that carries the particles", "motion by forces");
        if (setup.options.integrator.kind == IntegratorKind::implicit_euler && !setup.solver) {
            subject.refuse("integrator", name_of(setup.options.integrator.kind),
                           "an explicit one: the equations of implicit_euler do not hold forces on all together");
        }
    }
}

/// Validates moving and deforming colliders, whose positions within a step only the exact response computes.
void validate_moving_colliders(const SimulationSetup& setup) {
    for (std::size_t k = 0; k < setup.colliders.size(); ++k) {
        const ColliderDescription& collider = setup.colliders[k];
        const Subject subject("collider", k, collider.name);
        const auto refuse_frame = [&](bool refused, const char* expected) {
            if (refused) subject.refuse("frame", collider.frame, expected);
        };
        const bool deforms = is_deforming(collider);
        if (!deforms && collider.frame.empty()) continue;
        if (deforms) {
            refuse_frame(!collider.frame.empty(), "none: a mesh that deforms stands in the world");
        } else {
            const auto frame = setup.frames ? setup.frames->find(collider.frame) : std::nullopt;
            refuse_frame(!frame, "the name of a frame of the setup");
            refuse_frame(setup.frames->is_scaled(*frame),
                         "a frame without a scale: stretched_motion() says how a mesh in it deforms");
        }
        const char* const what = deforms ? "motion" : "frame";
        const std::string found = deforms ? "positions in time" : collider.frame;
        const char* const kind = deforms ? "meshes that deform" : "colliders that move";
        const ResponseKind response = setup.options.response;
        if (response != ResponseKind::exact) {
            subject.refuse(what, found,
                           fmt::format("none: the {} response knows no {}, only exact does", name_of(response), kind));
        }
        if (setup.options.flow) {
            subject.refuse(what, found, fmt::format("none: particles that a flow carries know no {}", kind));
        }
    }
}

/// Validates dynamic bodies, and refuses parts that exclude them.
void validate_bodies(const SimulationSetup& setup) {
    for (std::size_t k = 0; k < setup.bodies.size(); ++k) {
        const std::string& name = setup.bodies[k].frame;
        const Subject subject("body", k, name);
        const auto frame = setup.frames ? setup.frames->find(name) : std::nullopt;
        if (!frame || !setup.frames->description(*frame).is_driven) {
            subject.refuse("frame", name, "the name of a driven frame of the setup");
        }
        for (const ColliderDescription& collider : setup.colliders) {
            if (collider.frame != name) continue;
            visit_materials(collider, [&](std::uint32_t number) {
                const Material& material = setup.materials[number];
                if (material.suits_bodies()) return;
                subject.refuse("material", material.name,
                               "one that neither absorbs nor reflects diffusely, without a tangential factor");
            });
        }
        const auto is_on_it = [&](const EmitterDescription& emitter) {
            return emitter.frames &&
                   setup.frames->description(*frame).name == emitter.frames->description(emitter.frame).name;
        };
        if (std::ranges::any_of(setup.emitters, is_on_it)) {
            subject.refuse("emitter", "one in its frame", "none: where it will be within a step is not known");
        }
        if (!setup.springs.empty() || !setup.particles_forces.empty() || setup.solver) {
            subject.refuse("springs", "particles that act on each other", "none beside bodies that impulses move");
        }
    }
    for (std::size_t k = 0; setup.frames && k < setup.frames->size(); ++k) {
        const FrameDescription& frame = setup.frames->description(k);
        const auto count =
            std::ranges::count_if(setup.bodies, [&](const BodyDescription& body) { return body.frame == frame.name; });
        const Subject subject("frame", k, frame.name);
        if (count != (frame.is_driven ? 1 : 0)) subject.refuse("bodies", count, frame.is_driven ? "one" : "none");
        const auto parent = setup.frames->find(frame.parent);
        if (parent && setup.frames->description(*parent).is_driven) {
            subject.refuse("parent", frame.parent, "a frame that is not driven");
        }
    }
}

/// Refuses parts of a setup that exclude clouds, in which each particle is moved separately, after its parent.
void validate_clouds(const SimulationSetup& setup) {
    const auto found = std::ranges::find_if(setup.emitters, is_cloud);
    if (found == setup.emitters.end()) return;
    const Subject first("emitter", static_cast<std::size_t>(found - setup.emitters.begin()), found->name);
    const auto refuse = [&](std::string_view what, std::string_view expected) {
        first.refuse(what, "a cloud, whose particles go with their parents", expected);
    };
    if (setup.options.response != ResponseKind::exact) refuse("response", "one beside the response exact");
    if (setup.options.flow) refuse("motion", "one beside motion by forces");
    if (setup.options.particle_contacts) refuse("particle_contacts", "one where spheres do not meet each other");
    if (!setup.springs.empty() || setup.solver) refuse("springs", "one beside particles without springs");
    if (!setup.particles_forces.empty()) refuse("particle_forces", "one beside particles without forces between them");
    if (!setup.bodies.empty()) refuse("bodies", "one beside colliders that impulses do not move");
    if (std::ranges::any_of(setup.colliders, is_deforming)) {
        refuse("colliders", "one beside colliders that do not deform");
    }
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        if (!is_cloud(setup.emitters[k])) continue;
        const double turn = cloud_turn(*setup.emitters[k].parent->cloud, setup.options.time_step);
        if (turn <= kMostCloudTurnOfStep) continue;
        Subject("emitter", k, setup.emitters[k].name)
            .refuse("cloud", fmt::format("{:.3g} rad in a time step of {:g} s", turn, setup.options.time_step),
                    fmt::format("at most {:g}, by turning, pull (its root) and damping: take a shorter time step",
                                kMostCloudTurnOfStep));
    }
}

/// Refuses parts of a setup that a run of several processes cannot have.
void validate_ranks(const SimulationSetup& setup) {
    if (!setup.ranks || setup.ranks->size() < 2) return;
    const auto refuse = [&](const char* what, const char* why) {
        Subject(what).refuse("ranks", setup.ranks->size(),
                             fmt::format("1 (run it in one process, with threads): {}", why));
    };
    if (setup.solver) refuse("solver", "it steps all particles together");
    if (!setup.particles_forces.empty()) refuse("particle_forces", "each particle pulls at all others");
    if (setup.options.particle_contacts) refuse("particle_contacts", "spheres that meet move together");
    if (!setup.counters.empty()) refuse("counters", "each process counts only its own particles");
    if (!setup.bodies.empty()) refuse("bodies", "the impulses of all particles move a body within a step");
    if (std::ranges::any_of(setup.emitters, is_cloud)) {
        refuse("cloud", "children fly along the paths of their parents");
    }
    if (setup.options.response != ResponseKind::exact) refuse("response", "only exact moves each particle by itself");
    if (setup.options.verify) refuse("verify", "one process must collect the list of violations");
}

/// Refuses laws of impacts beside the penalty response, whose contacts last.
void validate_impact_laws(const SimulationSetup& setup) {
    if (setup.options.response != ResponseKind::penalty) return;
    for (std::size_t k = 0; k < setup.materials.size(); ++k) {
        if (!setup.materials[k].needs_instant_impacts()) continue;
        Subject("material", k, setup.materials[k].name)
            .refuse("tangential_restitution", "a law for impacts without duration",
                    "none (also no tangential_factor, static_friction, restitution_speed or impact_table) beside the "
                    "response penalty");
    }
}

}  // namespace

void validate_together(const SimulationSetup& setup) {
    validate_impact_laws(setup);
    validate_ranks(setup);
    validate_clouds(setup);
    validate_moving_colliders(setup);
    validate_bodies(setup);
    validate_particle_contacts(setup);
    validate_flow_walls(setup);
    validate_particles_forces(setup);
}

}  // namespace ricochet
