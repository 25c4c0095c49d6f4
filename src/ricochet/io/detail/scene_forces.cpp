// Forces and flows of a scene.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "ricochet/dynamics/flow_path.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/io/detail/scene_context.h"
#include "ricochet/io/vtk_reader.h"

namespace ricochet::detail {
namespace {

using ForcePointer = std::unique_ptr<Force>;

class ForceBuilder {
public:
    explicit ForceBuilder(const SceneContext& context) : context_(context) {
        const JsonNode::Object* members = context.root().node("flows").object();
        if (members == nullptr) return;
        const ObjectSpec& spec = *find_key(scene_spec(), nullptr, "flows")->content;
        for (const JsonMember& member : *members) {
            flows_[member.key] = flow(ObjectView(member.value, spec, path_of_key("flows", member.key)));
        }
    }

    /// Null pointer after reporting why there is none.
    [[nodiscard]] ForcePointer force(const ObjectView& view) const {
        ForcePointer force = made(view, [&] { return force_of(view); });
        if (!force || !view.has("particles")) return force;
        return make_force_on(view.whole_numbers("particles"), std::move(force));
    }

    // What the key "flow" says: an object, or the name of one.
    [[nodiscard]] FlowPointer flow_at(const ObjectView& view) const {
        if (!view.has("flow")) return nullptr;
        const std::string* name = view.node("flow").text();
        if (name == nullptr) return flow(view.object("flow"));
        const auto found = flows_.find(*name);
        if (found != flows_.end()) return found->second;
        std::vector<std::string_view> known;
        for (const auto& entry : flows_) known.push_back(entry.first);
        context_.error(view, "flow", unknown_name("flow", *name, known));
        return nullptr;
    }

private:
    // What the makers refuse is reported with its place. Where values were refused before, zeros stand in for them,
    // and what is said about those means nothing.
    template <class Make>
    [[nodiscard]] auto made(const ObjectView& view, const Make& make) const -> decltype(make()) {
        try {
            return make();
        } catch (const InputError& problem) {
            if (!context_.diagnostics().failed()) {
                context_.diagnostics().error(view.place(), view.path(), problem.what());
            }
            return nullptr;
        }
    }

    [[nodiscard]] FlowPointer flow(const ObjectView& view) const {
        FlowPointer flow = made(view, [&] { return view.type() == "grid" ? grid_of(view) : flow_of(view); });
        const double factor = view.type().empty() ? 1.0 : view.number("factor");
        return flow && factor != 1.0 ? make_scaled_flow(std::move(flow), factor) : flow;
    }

    [[nodiscard]] FlowPointer flow_of(const ObjectView& view) const {
        const std::string_view type = view.type();
        if (type == "uniform") return wind_of(view);
        if (type == "vortex") {
            return make_vortex(
                {view.vector("point"), view.vector("axis"), view.number("circulation"), view.number("core_radius"),
                 view.text("profile") == "rankine" ? VortexProfile::rankine : VortexProfile::lamb_oseen});
        }
        if (type == "radial") {
            return make_source(view.vector("center"), view.number("strength"), view.number("core_radius"));
        }
        if (type == "rotation") return make_rotation(view.vector("point"), view.vector("angular_velocity"));
        if (type == "shear") return make_shear(view.vector("point"), view.vector("rate"), view.vector("gradient"));
        if (type == "turbulence") {
            return make_turbulence({view.whole_number("seed"), view.number("speed"), view.number("length"),
                                    static_cast<std::uint32_t>(view.whole_number("octaves")), view.number("gain"),
                                    view.number("rate")});
        }
        if (type == "sphere") {
            return make_flow_past_sphere(view.vector("center"), view.number("radius"), view.vector("velocity"));
        }
        return type == "sum" ? sum_of(view) : nullptr;
    }

    [[nodiscard]] static FlowPointer wind_of(const ObjectView& view) {
        if (!view.has("gust")) return make_wind(view.vector("velocity"));
        const ObjectView gust = view.object("gust");
        return make_gusty_wind(view.vector("velocity"),
                               {gust.number("amplitude"), gust.number("frequency"), gust.number("phase")});
    }

    [[nodiscard]] FlowPointer sum_of(const ObjectView& view) const {
        std::vector<FlowPointer> parts;
        for (const ObjectView& part : view.objects("parts")) parts.push_back(flow(part));
        return std::find(parts.begin(), parts.end(), nullptr) == parts.end() ? make_flow_sum(std::move(parts))
                                                                             : nullptr;
    }

    [[nodiscard]] FlowPointer grid_of(const ObjectView& view) const {
        if (!view.has("file")) return nullptr;
        try {
            return make_grid_flow(read_vti(context_.file_of(view), view.text("array")),
                                  view.text("outside") == "zero" ? OutsideGrid::zero : OutsideGrid::clamp);
        } catch (const InputError& problem) {
            context_.error(view, "file", problem.what());
            return nullptr;
        }
    }

    [[nodiscard]] ForcePointer force_of(const ObjectView& view) const {
        const std::string_view type = view.type();
        if (type == "gravity") return make_gravity(view.vector("acceleration"));
        if (type == "point_gravity") return make_point_gravity(attractors_of(view));
        if (type == "buoyancy") return make_buoyancy(view.number("fluid_density"), view.vector("gravity"));
        if (type == "radial") {
            return make_radial_force({view.vector("center"), view.number("strength"), view.number("exponent"),
                                      view.number("softening"), view.number("reference")});
        }
        if (type == "swirl") {
            return make_swirl(view.vector("point"), view.vector("axis"), view.number("acceleration"),
                              view.number("core_radius"));
        }
        if (type == "lorentz") {
            return make_lorentz_force({view.number("charge"), view.vector("electric"), view.vector("magnetic")});
        }
        if (type == "anchor") {
            return make_anchor({view.vector("position"), view.number("stiffness"), view.number("rest_length"),
                                view.number("damping")});
        }
        return force_with_flow(view);
    }

    [[nodiscard]] ForcePointer force_with_flow(const ObjectView& view) const {
        const std::string_view type = view.type();
        if (type.empty()) return nullptr;
        FlowPointer flow = flow_at(view);
        if (type == "drag") return make_linear_drag(view.number("coefficient"), std::move(flow));
        if (type == "quadratic_drag" && view.has("coefficient")) {
            return make_quadratic_drag(view.number("coefficient"), std::move(flow));
        }
        if (type == "quadratic_drag") {
            return make_sphere_drag(view.number("drag_coefficient"), view.number("fluid_density"), std::move(flow));
        }
        if (type == "stokes_drag") return make_stokes_drag(view.number("viscosity"), std::move(flow));
        if (type == "schiller_naumann_drag") {
            return make_schiller_naumann_drag(view.number("fluid_density"), view.number("viscosity"), std::move(flow));
        }
        return make_field_force(std::move(flow),
                                view.text("as") == "force" ? FieldMeaning::force : FieldMeaning::acceleration);
    }

    [[nodiscard]] static std::vector<Attractor> attractors_of(const ObjectView& view) {
        std::vector<Attractor> attractors;
        for (const ObjectView& item : view.objects("attractors")) {
            attractors.push_back({item.vector("position"), item.number("strength"), item.number("softening")});
        }
        return attractors;
    }

    const SceneContext& context_;
    std::map<std::string, FlowPointer, std::less<>> flows_;
};

bool grows_with_radius(const ObjectView& view) {
    const std::string_view type = view.type();
    return type == "stokes_drag" || type == "schiller_naumann_drag" || type == "buoyancy" ||
           (type == "quadratic_drag" && !view.has("coefficient"));
}

// First-order motion: the flow that carries the particles, and what does not go with it.
void build_motion(const SceneContext& context, const ForceBuilder& builder, SimulationOptions& options) {
    const ObjectView view = context.root().object("simulation");
    const bool is_carried = view.text("motion") == "flow";
    const FlowPointer flow = builder.flow_at(view);
    if (!is_carried) {
        for (const char* key : {"flow", "walls"}) {
            if (view.has(key)) context.error(view, key, "only goes together with \"motion\": \"flow\"");
        }
        return;
    }
    options.flow = flow;
    options.walls = view.text("walls") == "stop" ? WallRule::stop : WallRule::slide;
    if (!view.has("flow")) context.error(view, "flow", "missing, expected the flow that carries the particles");
    if (!view.has("integrator")) options.integrator.kind = IntegratorKind::rk4;
    if (!carries_along_flows(options.integrator.kind)) {
        context.error(view, "integrator",
                      fmt::format("found \"{}\", which has no meaning where a flow carries the particles, expected "
                                  "\"forward_euler\", \"midpoint\", \"rk4\" or \"dormand_prince\"",
                                  name_of(options.integrator.kind)));
    }
    if (options.response != ResponseKind::exact) {
        context.error(
            view, "response",
            fmt::format("found \"{}\", expected \"exact\": a flow carries the particles", name_of(options.response)));
    }
    if (!context.objects("forces").empty()) {
        context.error(context.root(), "forces", "a flow carries the particles, forces would do nothing: expected none");
    }
}

}  // namespace

void build_forces(const SceneContext& context, SimulationSetup& setup) {
    const ForceBuilder builder(context);
    build_motion(context, builder, setup.options);
    for (const ObjectView& view : context.objects("forces")) {
        if (ForcePointer force = builder.force(view)) setup.forces.push_back(std::move(force));
    }
}

void warn_of_forces_without_radius(const SceneContext& context, const SimulationSetup& setup) {
    const auto is_point = [](const Particle& particle) { return particle.radius == 0.0; };
    const auto emits_points = [](const EmitterDescription& emitter) {
        return emitter.radius.mean == 0.0 && emitter.radius.spread == 0.0;
    };
    if (!std::all_of(setup.particles.begin(), setup.particles.end(), is_point) ||
        !std::all_of(setup.emitters.begin(), setup.emitters.end(), emits_points)) {
        return;
    }
    for (const ObjectView& view : context.objects("forces")) {
        if (!grows_with_radius(view)) continue;
        context.warn(view, "type",
                     "this force grows with the particles' radius, and all particles are points: it does nothing");
    }
}

}  // namespace ricochet::detail
