// Forces of a scene: the keys of each type, and the function that makes the force.

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

using ForcePointer = std::unique_ptr<Force>;
using ForceLaw = Law<ForcePointer, FlowPointer>;

template <class Settings, class Maker>
ForceLaw force_law(std::string_view name, std::string_view description, const Fields<Settings>& fields, Maker make,
                   std::vector<std::string_view> exactly_one_of = {}) {
    return {variant(name, description, fields, std::move(exactly_one_of)),
            [make](const ObjectView& view, const FlowPointer& flow) {
                if constexpr (std::invocable<Maker, Settings, FlowPointer>) {
                    return make(view.read<Settings>(), flow);
                } else {
                    return make(view.read<Settings>());
                }
            }};
}

template <class Struct>
Field<Struct> softening(double Struct::*member, std::string_view meaning) {
    return {"softening", member, kLengthOrZero, "m", meaning};
}

template <class Struct, class... Options>
Field<Struct> flow_field(Options... options) {
    return {"flow",       ValueType::named_object, "Motion of the fluid: a flow, or the name of one in `flows`.",
            &flow_spec(), NamedIn{"flows"},        options...};
}
constexpr Without kWorldBody{"at rest"};

// Drag forces.

struct Fluid {
    double density = 1.204;      // kg/m^3, air at 20 degrees C
    double viscosity = 1.82e-5;  // Pa s
};

Field<Fluid> viscosity() {
    return {"viscosity", &Fluid::viscosity, kPositive, "Pa s",
            "Dynamic viscosity of the fluid. The default is air at 20 degrees C."};
}

constexpr std::string_view kDensityMeaning = "Density of the fluid. The default is air at 20 degrees C.";

ForceLaw linear_drag() {
    struct Drag {
        double coefficient = 0.0;
    };
    return force_law<Drag>(
        "drag", "Linear drag F = -c w, with the velocity w relative to the flow.",
        {{"coefficient", &Drag::coefficient, kNotNegative, "kg/s", "Coefficient c.", kRequired},
         flow_field<Drag>(kWorldBody)},
        [](const Drag& d, FlowPointer flow) { return make_linear_drag(d.coefficient, std::move(flow)); });
}

ForceLaw quadratic_drag() {
    struct Drag {
        std::optional<double> coefficient;
        std::optional<double> drag_coefficient;
        Fluid fluid;
    };
    return force_law<Drag>("quadratic_drag",
                           "Drag of fast bodies: F = -c |w| w, or -1/2 rho C_d pi r^2 |w| w with the particle's radius "
                           "r (none for points). w is the velocity relative to the flow.",
                           {{"coefficient", &Drag::coefficient, kNotNegative, "kg/m", "Coefficient c."},
                            {"drag_coefficient", &Drag::drag_coefficient, kNotNegative, "",
                             "Drag coefficient C_d, for particles with a radius."},
                            {"fluid_density", [](Drag& d) -> double& { return d.fluid.density; }, kNotNegative,
                             "kg/m^3", kDensityMeaning, Needs{"drag_coefficient"}},
                            flow_field<Drag>(kWorldBody)},
                           [](const Drag& d, FlowPointer flow) {
                               return d.coefficient ? make_quadratic_drag(*d.coefficient, std::move(flow))
                                                    : make_sphere_drag(d.drag_coefficient.value_or(0.0),
                                                                       d.fluid.density, std::move(flow));
                           },
                           {"coefficient", "drag_coefficient"});
}

ForceLaw stokes_drag() {
    return force_law<Fluid>(
        "stokes_drag", "Drag of slow small spheres: F = -6 pi mu r w, with the particle's radius r (none for points).",
        {viscosity(), flow_field<Fluid>(kWorldBody)},
        [](const Fluid& fluid, FlowPointer flow) { return make_stokes_drag(fluid.viscosity, std::move(flow)); });
}

ForceLaw schiller_naumann_drag() {
    return force_law<Fluid>("schiller_naumann_drag",
                            "Drag of spheres at any speed, with the particle's radius (none for points). C_d = 24 / Re "
                            "(1 + 0.15 Re^0.687) below Re = 1000, and 0.44 above.",
                            {{"fluid_density", &Fluid::density, kNotNegative, "kg/m^3", kDensityMeaning},
                             viscosity(),
                             flow_field<Fluid>(kWorldBody)},
                            [](const Fluid& fluid, FlowPointer flow) {
                                return make_schiller_naumann_drag(fluid.density, fluid.viscosity, std::move(flow));
                            });
}

ForceLaw buoyancy() {
    struct Lift {
        double fluid_density = 0.0;
        Vec3 gravity;
    };
    return force_law<Lift>(
        "buoyancy", "Buoyancy of a particle in the fluid: F = -rho 4/3 pi r^3 g (none for points).",
        {{"fluid_density", &Lift::fluid_density, kNotNegative, "kg/m^3", "Density of the fluid.", kRequired},
         {"gravity", &Lift::gravity, kCoordinate, "m/s^2", "Gravitational acceleration g.", kRequired}},
        [](const Lift& l) { return make_buoyancy(l.fluid_density, l.gravity); });
}

ForceLaw thermal_buoyancy() {
    struct Lift {
        double ambient_temperature = 293.15;
        Vec3 gravity;
    };
    return force_law<Lift>(
        "thermal_buoyancy",
        "Buoyancy of gas parcels by their attribute `temperature`: a = -g T / Ta. Together with a separate gravity "
        "force the sum is g (1 - T / Ta). Particles at 0 K have none.",
        {{"ambient_temperature", &Lift::ambient_temperature, kPositive, "K", "Temperature Ta of the surrounding gas."},
         {"gravity", &Lift::gravity, kCoordinate, "m/s^2", "Gravitational acceleration g.", kRequired}},
        [](const Lift& l) { return make_thermal_buoyancy(l.ambient_temperature, l.gravity); });
}

// Force fields.

ForceLaw gravity() {
    struct Gravity {
        Vec3 acceleration;
    };
    return force_law<Gravity>(
        "gravity", "The same acceleration everywhere.",
        {{"acceleration", &Gravity::acceleration, kCoordinate, "m/s^2", "Acceleration.", kRequired}},
        [](const Gravity& g) { return make_gravity(g.acceleration); });
}

const ObjectSpec& attractor_spec() {
    using A = Attractor;
    static const ObjectSpec spec =
        object<A>("attractor", "A point that attracts.",
                  {{"position", &A::position, kCoordinate, "m", "Position of the point.", kRequired},
                   {"strength", &A::strength, kCoordinate, "m^3/s^2",
                    "Gravitational constant times mass. Negative values repel.", kRequired},
                   softening(&A::softening, "Length over which its mass is spread.")});
    return spec;
}

ForceLaw point_gravity() {
    struct PointMasses {
        std::vector<Attractor> attractors;
    };
    return force_law<PointMasses>(
        "point_gravity", "Gravity of point masses: a = -G M d / (|d|^2 + softening^2)^(3/2).",
        {{"attractors", &PointMasses::attractors,
          "Objects with `position` (m), `strength` (G M, m^3/s^2) and `softening` (m, 0 by default).",
          &attractor_spec(), kRequired}},
        [](PointMasses masses) { return make_point_gravity(std::move(masses.attractors)); });
}

ForceLaw radial_force() {
    using R = RadialForceSettings;
    return force_law<R>("radial",
                        "Force towards a centre by a power of the distance d: |F| = strength (s / reference)^exponent "
                        "d / s, with s^2 = d^2 + softening^2.",
                        {center(&R::center),
                         {"strength", &R::strength, kCoordinate, "N",
                          "Force at the reference distance. Negative values push away.", kRequired},
                         {"exponent", &R::exponent, between(-kLargestRadialExponent, kLargestRadialExponent), "",
                          "1 for a spring, -2 for Coulomb's law."},
                         softening(&R::softening, "Distance below which the force weakens."),
                         {"reference", &R::reference, kLength, "m", "Distance at which the force has this strength."}},
                        &make_radial_force);
}

ForceLaw swirl() {
    struct Swirl {
        Vec3 point;
        Vec3 axis{0, 0, 1};
        double acceleration = 0.0;
        double core_radius = 1.0;
    };
    return force_law<Swirl>(
        "swirl", "Force around an axis. It grows linearly within the core and falls as one over the distance outside.",
        {axis_point(&Swirl::point),
         axis(&Swirl::axis),
         {"acceleration", &Swirl::acceleration, kCoordinate, "m/s^2",
          "Acceleration at the rim of the core. Negative values reverse the direction.", kRequired},
         {"core_radius", &Swirl::core_radius, kLength, "m", "Radius of the core.", kRequired}},
        [](const Swirl& s) { return make_swirl(s.point, s.axis, s.acceleration, s.core_radius); });
}

ForceLaw field_force() {
    struct FieldKeys {
        FieldMeaning meaning = FieldMeaning::acceleration;
    };
    return force_law<FieldKeys>(
        "field", "Vectors of a flow, used as accelerations or forces.",
        {flow_field<FieldKeys>(kRequired),
         {"as", &FieldKeys::meaning, "Meaning of the vectors.",
          Choices{choice(FieldMeaning::acceleration, "acceleration", "m/s^2, the same for every mass"),
                  choice(FieldMeaning::force, "force", "N")}}},
        [](const FieldKeys& field, FlowPointer flow) { return make_field_force(std::move(flow), field.meaning); });
}

ForceLaw lorentz_force() {
    using L = LorentzSettings;
    return force_law<L>("lorentz", "Force on charged particles in uniform fields: F = q (E + v x B).",
                        {{"charge", &L::charge, kCoordinate, "C", "Charge of every particle.", kRequired},
                         {"electric", &L::electric, kCoordinate, "V/m", "Electric field E."},
                         {"magnetic", &L::magnetic, kCoordinate, "T", "Magnetic field B."}},
                        &make_lorentz_force);
}

ForceLaw anchor_force() {
    using A = AnchorSettings;
    return force_law<A>(
        "anchor", "A spring and damper to a fixed point. The damper acts along the spring.",
        {{"position", &A::position, kCoordinate, "m", "Position of the fixed point.", kRequired},
         {"stiffness", &A::stiffness, kNotNegative, "N/m", "Spring constant.", kRequired},
         {"rest_length", &A::rest_length, kLengthOrZero, "m", "Length at which the spring exerts no force."},
         {"damping", &A::damping, kNotNegative, "kg/s", "Force divided by the speed along the spring."}},
        &make_anchor);
}

const std::vector<ForceLaw>& force_laws() {
    static const std::vector<ForceLaw> laws = {
        gravity(),     linear_drag(),      quadratic_drag(), stokes_drag(),  schiller_naumann_drag(),
        buoyancy(),    thermal_buoyancy(), point_gravity(),  radial_force(), swirl(),
        field_force(), lorentz_force(),    anchor_force()};
    return laws;
}

// Keys of every force.
struct ForceKeys {
    std::vector<std::uint64_t> particles;
};

bool grows_with_radius(const ObjectView& view) {
    const std::string_view type = view.type();
    return type == "stokes_drag" || type == "schiller_naumann_drag" || type == "buoyancy" ||
           (type == "quadratic_drag" && !view.has("coefficient"));
}

}  // namespace

const ObjectSpec& force_spec() {
    static const ObjectSpec spec = object<ForceKeys>(
        "force", "A force on particles. Forces add up.",
        {{"particles", &ForceKeys::particles, "Ids of the particles that it acts on.", Without{"all"}}},
        variants_of(force_laws()));
    return spec;
}

std::vector<ForcePointer> ForceBuilder::forces() const {
    std::vector<ForcePointer> forces;
    for (const ObjectView& view : context_.objects("forces")) {
        const ForceLaw* law = law_of(force_laws(), view);
        if (law == nullptr) continue;
        const FlowPointer flow = flow_at(view);
        ForcePointer force = made(context_, view, [&] { return law->make(view, flow); });
        if (force && view.has("particles")) {
            force = make_force_on(view.read<ForceKeys>().particles, std::move(force));
        }
        if (force) forces.push_back(std::move(force));
    }
    return forces;
}

void warn_of_unknown_ids(const SceneContext& context, const ObjectView& view, const SimulationSetup& setup,
                         std::span<const std::uint64_t> ids) {
    if (!setup.emitters.empty()) return;  // emitters may create these ids later
    const auto is_unknown = [&](std::uint64_t id) { return id >= setup.particles.size(); };
    const auto unknown = std::ranges::find_if(ids, is_unknown);
    if (unknown == ids.end()) return;
    context.warn(
        view, "particles",
        fmt::format("no particle has the id {}: ids are given from 0 on in the order of the scene's particles, of "
                    "which there are {}, and nothing is born; the force does not act on it",
                    *unknown, setup.particles.size()));
}

void warn_of_forces_on_nobody(const SceneContext& context, const SimulationSetup& setup) {
    for (const ObjectView& view : context.objects("forces")) {
        if (view.has("particles")) warn_of_unknown_ids(context, view, setup, view.read<ForceKeys>().particles);
    }
}

bool has_only_points(const SimulationSetup& setup) {
    const auto is_point = [](const Particle& particle) { return particle.radius == 0.0; };
    const auto emits_points = [](const EmitterDescription& emitter) { return emitter.radius.most() == 0.0; };
    return std::ranges::all_of(setup.particles, is_point) && std::ranges::all_of(setup.emitters, emits_points);
}

void warn_of_forces_without_radius(const SceneContext& context, const SimulationSetup& setup) {
    if (!has_only_points(setup)) return;
    for (const ObjectView& view : context.objects("forces")) {
        if (!grows_with_radius(view)) continue;
        context.warn(view, "type",
                     "this force grows with the particles' radius, and all particles are points: it does nothing");
    }
}

}  // namespace ricochet::detail
