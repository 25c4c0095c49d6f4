// Heat of a scene: processes that change the temperatures of its particles.

#include "ricochet/dynamics/heat.h"

#include <string>
#include <string_view>

#include "ricochet/io/scene/context.h"
#include "ricochet/simulation/validation.h"

namespace ricochet::detail {
namespace {

const ObjectSpec& convection_spec() {
    using C = Convection;
    static const ObjectSpec spec = object<C>(
        "convection",
        "Heat exchange between spheres and the medium, by a coefficient or by the correlation of Ranz and Marshall: Nu "
        "= 2 + 0.6 Re^(1/2) Pr^(1/3). Re uses the speed relative to the flow. The defaults describe air at 20 degrees "
        "C.",
        {{"coefficient", &C::coefficient, kNotNegative, "W/(m^2 K)",
          "Coefficient h in dT/dt = -h A (T - Ta) / (m c). It excludes all other keys.", Without{"the correlation"}},
         {"conductivity", &C::conductivity, kPositive, "W/(m K)", "Thermal conductivity of the medium."},
         {"fluid_density", &C::density, kNotNegative, "kg/m^3", "Density of the medium."},
         {"viscosity", &C::viscosity, kPositive, "Pa s", "Dynamic viscosity of the medium."},
         {"prandtl", &C::prandtl, kPositive, "", "Prandtl number of the medium."},
         {"flow", ValueType::named_object, "Motion of the medium: a flow, or the name of one in `flows`.", &flow_spec(),
          NamedIn{"flows"}, Without{"at rest"}}});
    return spec;
}

}  // namespace

const ObjectSpec& heat_spec() {
    using H = HeatSettings;
    static const ObjectSpec spec = object<H>(
        "heat",
        "Processes that change the attribute `temperature` (K) of all particles. The attribute must be declared. The "
        "temperature is uniform inside a particle.",
        {{"specific_heat", &H::specific_heat, between(1e-3, 1e12), "J/(kg K)", "Specific heat of the particles.",
          kRequired},
         {"ambient_temperature", &H::ambient_temperature, kNotNegative, "K",
          "Temperature of the medium, and of the surroundings that particles exchange radiation with."},
         {"convection", &H::convection, "Heat exchange with the medium.", &convection_spec(), Without{"none"}},
         {"emissivity", &H::emissivity, kFraction, "",
          "Heat that spheres radiate and absorb, divided by that of black bodies."},
         {"impact_fraction", &H::impact_fraction, kFraction, "",
          "Fraction of the energy lost along the normal at impacts, by restitution, that heats the particle."},
         {"friction_fraction", &H::friction_fraction, kFraction, "",
          "Fraction of the energy lost by friction, in impacts and in contact, that heats the particle."}});
    return spec;
}

namespace {

/// Removes "heat: " from the start of a message, because the report names the key already.
std::string without_own_name(std::string message) {
    constexpr std::string_view kName = "heat: ";
    return message.starts_with(kName) ? message.substr(kName.size()) : message;
}

FlowPointer flow_of(const SceneContext& context, const ForceBuilder& forces, const ObjectView& convection) {
    for (const char* key : {"conductivity", "fluid_density", "viscosity", "prandtl", "flow"}) {
        if (!convection.has("coefficient") || !convection.has(key)) continue;
        context.error(convection, key, "has no part beside a `coefficient`, expected one of the two");
    }
    return forces.flow_at(convection);
}

}  // namespace

void build_heat(const SceneContext& context, const ForceBuilder& forces, SimulationSetup& setup) {
    if (!context.failed()) {
        try {
            validate_thermal_forces(setup);
        } catch (const InputError& problem) {
            context.error(context.root(), "forces", problem.what());
        }
    }
    if (!context.root().has("heat")) return;
    const ObjectView view = context.root().object("heat");
    setup.heat = view.read<HeatSettings>();
    if (setup.heat->convection) setup.heat->convection->flow = flow_of(context, forces, view.object("convection"));
    if (context.failed()) return;
    try {
        validate_heat(setup);
    } catch (const InputError& problem) {
        context.error(context.root(), "heat", without_own_name(problem.what()));
    }
}

}  // namespace ricochet::detail
