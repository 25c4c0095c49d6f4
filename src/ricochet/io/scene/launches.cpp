// Directions, velocities and masses at birth in scenes.
#include <string>
#include <variant>

#include "ricochet/core/error.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

constexpr Range kHot = positive_up_to(kTemperature.upper);

// Returns true if the direction is given, or every position of the shape has its own.
bool has_direction(const EmitterDescription& emitter) {
    const auto* const sphere = std::get_if<SphereShape>(&emitter.shape);
    return emitter.direction != Vec3{} || std::holds_alternative<DiskShape>(emitter.shape) ||
           std::holds_alternative<ConeShape>(emitter.shape) ||
           std::holds_alternative<MeshSurfaceShape>(emitter.shape) || (sphere != nullptr && sphere->surface);
}

constexpr const char* kNeedsDirection =
    "needs a direction: set \"direction\", or use a disk, a cone, a mesh or the surface of a sphere";

void check_thermal(const SceneContext& context, const ObjectView& view, const EmitterDescription& emitter) {
    for (const char* const key : {"speed", "cone", "direction_law"}) {
        if (view.has(key)) context.error(view, key, "\"thermal\" gives direction and speed, leave out one of the two");
    }
    const ObjectView object = view.object("thermal");
    const bool is_effusion = emitter.thermal->law == ThermalLaw::effusion;
    if (is_effusion && !has_direction(emitter)) context.error(object, "law", kNeedsDirection);
    if (!is_effusion && view.has("direction")) {
        context.error(view, "direction", "velocities in a volume have any direction, leave it out");
    }
    if (!is_effusion && object.has("drift")) {
        context.error(object, "drift", "is only for \"law\": \"effusion\"; expected the emitter's \"velocity\"");
    }
    if (!object.is_complete() || (object.has("drift") && !is_effusion)) return;
    if (const std::string problem = thermal_problem(*emitter.thermal); !problem.empty()) {
        context.error(view, "thermal", problem);
    }
}

void check_directions(const SceneContext& context, const ObjectView& view, EmitterDescription& emitter) {
    if (emitter.direction_law != DirectionLaw::cosine) return;
    if (!view.has("cone")) emitter.cone_degrees = 90.0;
    if (!(emitter.cone_degrees > 0.0 && emitter.cone_degrees <= 90.0)) {
        context.error(view, "cone", "the cosine law ends at 90 degrees, expected a number > 0 and <= 90 (degrees)");
    } else if (!has_direction(emitter)) {
        context.error(view, "direction_law", kNeedsDirection);
    }
}

void check_density(const SceneContext& context, const ObjectView& view, const EmitterDescription& emitter) {
    if (!emitter.density) return;
    if (view.has("mass")) context.error(view, "mass", "follows from \"density\", leave out one of the two");
    if (emitter.parent && emitter.parent->share) {
        context.error(view, "density", "shares keep the density of their parent, leave it out");
    } else if (!kMass.contains(least_mass(emitter))) {
        context.error(view, "density",
                      "gives a particle no mass, expected a \"particle_radius\" above 0 for every particle");
    }
}

}  // namespace

const ObjectSpec& thermal_spec() {
    using T = ThermalLaunch;
    static const ObjectSpec spec = object<T>(
        "thermal launch", "Velocities of the molecules of a gas in equilibrium.",
        {{"law", &T::law, "Law of the velocities.",
          Choices{choice(ThermalLaw::volume, "volume", "those in a volume: each component is normal"),
                  choice(ThermalLaw::effusion, "effusion",
                         "those that leave through an opening along the direction, in proportion to their speed "
                         "along it")}},
         {"temperature", &T::temperature, kHot, "K", "Temperature of the gas.", kRequired},
         {"molecule_mass", &T::molecule_mass, kMass, "kg", "Mass of a molecule of the gas.", kRequired},
         {"drift", &T::drift, kCoordinate, "m/s",
          "For `effusion`: mean speed of the gas along the direction, before it leaves."}});
    return spec;
}

Fields<EmitterDescription> body_fields() {
    using E = EmitterDescription;
    return {{"mass", &E::mass, kMass, "kg", "Mass of a particle.", LowEnd{kMass}, &distribution_spec()},
            {"density", &E::density, kPositive, "kg/m^3",
             "Instead of `mass`: density of a solid sphere of the drawn `particle_radius`.", Without{"`mass` applies"}},
            {"lifetime", &E::lifetime, kNotNegative, "s", "Time after birth at which a particle is retired.",
             LowEnd{kNotNegative}, Without{"for ever"}, &distribution_spec()},
            {"particle_radius", &E::radius, kLengthOrZero, "m", "Radius of a particle.", LowEnd{kNotNegative},
             &distribution_spec()}};
}

void check_launch(const SceneContext& context, const ObjectView& view, EmitterDescription& emitter) {
    const bool is_drawn = check_drawn(context, view, "speed", emitter.speed, kCoordinate) &&
                          check_drawn(context, view, "mass", emitter.mass, kMass) &&
                          check_drawn(context, view, "lifetime", emitter.lifetime, kNotNegative) &&
                          check_drawn(context, view, "particle_radius", emitter.radius, kLengthOrZero);
    if (!is_drawn) {
        // Later checks need values, and the scene is refused.
        emitter.speed = emitter.radius = 0.0;
        emitter.mass = emitter.lifetime = 1.0;
        emitter.density.reset();
    }
    if (emitter.thermal) check_thermal(context, view, emitter);
    check_directions(context, view, emitter);
    check_density(context, view, emitter);
}

}  // namespace ricochet::detail
