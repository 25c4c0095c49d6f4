// Heat of a scene: processes that change the temperatures of its particles.

#include "ricochet/dynamics/heat.h"

#include <string>
#include <string_view>

#include "ricochet/dynamics/settings_table.h"
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
        joined<C>({fields_of<C>(kConvectionTable),
                   {{"flow", ValueType::named_object, "Motion of the medium: a flow, or the name of one in `flows`.",
                     &flow_spec(), NamedIn{"flows"}, Without{"at rest"}}}}));
    return spec;
}

/// Removes "heat: " from the start of a message, because the report already contains the path of the key.
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

const ObjectSpec& heat_spec() {
    using H = HeatSettings;
    static const ObjectSpec spec = object<H>(
        "heat",
        "Processes that change the attribute `temperature` (K) of all particles. The attribute must be declared. The "
        "temperature is uniform inside a particle.",
        joined<H>(
            {fields_of<H>(kHeatTable),
             {{"convection", &H::convection, "Heat exchange with the medium.", &convection_spec(), Without{"none"}}},
             fields_of<H>(kHeatFractionTable)}));
    return spec;
}

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
