// Flows of a scene: the keys of each type, and the function that makes the flow.

#include <utility>

#include "ricochet/io/scene/context.h"
#include "ricochet/io/vti_reader.h"

namespace ricochet::detail {
namespace {

using FlowLaw = Law<FlowPointer, SceneContext>;

template <class Settings, class Maker>
FlowLaw flow_law(std::string_view name, std::string_view description, const Fields<Settings>& fields, Maker make) {
    return {variant(name, description, fields),
            [make](const ObjectView& view, const SceneContext&) { return make(view.read<Settings>()); }};
}

/// Keys of every flow.
struct FlowKeys {
    double factor = 1.0;
};

const ObjectSpec& gust_spec() {
    static const ObjectSpec spec =
        object<Gust>("gust", "The wind is multiplied by 1 + amplitude sin(2 pi (frequency t + phase)).",
                     {{"amplitude", &Gust::amplitude, kNotNegative, "",
                       "Fraction of the wind speed. Above 1 the wind reverses at times.", kRequired},
                      {"frequency", &Gust::frequency, kNotNegative, "Hz", "Frequency of the variation.", kRequired},
                      {"phase", &Gust::phase, kCoordinate, "turns", "Phase of the cycle at 0 s."}});
    return spec;
}

FlowLaw uniform_flow() {
    struct Wind {
        Vec3 velocity;
        std::optional<Gust> gust;
    };
    return flow_law<Wind>(
        "uniform", "A wind with the same velocity everywhere.",
        {{"velocity", &Wind::velocity, kCoordinate, "m/s", "Velocity of the wind.", kRequired},
         {"gust", &Wind::gust,
          "Periodic variation: `amplitude` (fraction of the speed), `frequency` (Hz) and `phase` (turns, 0 by "
          "default).",
          &gust_spec(), Without{"steady"}}},
        [](const Wind& w) { return w.gust ? make_gusty_wind(w.velocity, *w.gust) : make_wind(w.velocity); });
}

FlowLaw vortex_flow() {
    using V = VortexSettings;
    return flow_law<V>(
        "vortex", "A straight vortex of infinite length.",
        {axis_point(&V::point),
         axis(&V::axis),
         {"circulation", &V::circulation, kCoordinate, "m^2/s",
          "Speed times circumference, outside the core. Negative values reverse the rotation.", kRequired},
         {"core_radius", &V::core_radius, kLength, "m",
          "Radius of the core. Inside it the speed falls to 0 on the axis.", kRequired},
         {"profile", &V::profile, "Speed as a function of the distance.",
          Choices{choice(VortexProfile::rankine, "rankine", "the core turns like a rigid body"),
                  choice(VortexProfile::lamb_oseen, "lamb_oseen",
                         "smooth, like a line vortex that viscosity has spread")}}},
        &make_vortex);
}

FlowLaw radial_flow() {
    struct Source {
        Vec3 center;
        double strength = 0.0;
        double core_radius = 1.0;
    };
    return flow_law<Source>("radial", "A source or a sink with a soft core.",
                            {center(&Source::center),
                             {"strength", &Source::strength, kCoordinate, "m^3/s",
                              "Volume flow out of the source. Negative for a sink.", kRequired},
                             {"core_radius", &Source::core_radius, kLength, "m",
                              "Radius of the core. Inside it the speed falls to 0.", kRequired}},
                            [](const Source& s) { return make_source(s.center, s.strength, s.core_radius); });
}

FlowLaw rotation_flow() {
    struct Rotation {
        Vec3 point;
        Vec3 angular_velocity;
    };
    return flow_law<Rotation>("rotation", "Rotation like a rigid body.",
                              {axis_point(&Rotation::point),
                               {"angular_velocity", &Rotation::angular_velocity, kCoordinate, "rad/s",
                                "Angular velocity along the axis, by the right-hand rule.", kRequired}},
                              [](const Rotation& r) { return make_rotation(r.point, r.angular_velocity); });
}

FlowLaw shear_flow() {
    struct Shear {
        Vec3 point;
        Vec3 rate;
        Vec3 gradient{1, 0, 0};
    };
    return flow_law<Shear>("shear", "A velocity that grows linearly along a direction.",
                           {{"point", &Shear::point, kCoordinate, "m", "A point where the fluid is at rest."},
                            {"rate", &Shear::rate, kCoordinate, "1/s", "Velocity gain per metre.", kRequired},
                            {"gradient", &Shear::gradient, kCoordinate, "",
                             "Direction along which the velocity grows, of any length.", kRequired, kNotZero}},
                           [](const Shear& s) { return make_shear(s.point, s.rate, s.gradient); });
}

FlowLaw turbulence_flow() {
    using T = TurbulenceSettings;
    return flow_law<T>("turbulence", "Eddies of several sizes without divergence (curl noise).",
                       {{"speed", &T::speed, kNotNegative, "m/s", "Root mean square of the speed.", kRequired},
                        {"length", &T::length, kLength, "m", "Size of the largest eddies.", kRequired},
                        {"octaves", &T::octaves, between(1, kMostOctaves), "",
                         "Number of eddy sizes. Each size is half the previous one."},
                        {"gain", &T::gain, positive_up_to(1.0), "",
                         "Speed of the eddies of one size divided by the speed at the previous size."},
                        {"rate", &T::rate, kNotNegative, "1/s",
                         "Rate at which new eddies replace the largest ones. 0 freezes the flow."},
                        {"seed", &T::seed, kSeed, "", "Seed of the turbulence, independent of the simulation's seed."}},
                       &make_turbulence);
}

FlowLaw sphere_flow() {
    struct Ball {
        Vec3 center;
        double radius = 1.0;
        Vec3 velocity;
    };
    return flow_law<Ball>("sphere", "Flow of an ideal fluid past a ball. The fluid inside the ball is at rest.",
                          {center(&Ball::center),
                           {"radius", &Ball::radius, kLength, "m", "Radius of the ball.", kRequired},
                           {"velocity", &Ball::velocity, kCoordinate, "m/s", "Velocity far from the ball.", kRequired}},
                          [](const Ball& b) { return make_flow_past_sphere(b.center, b.radius, b.velocity); });
}

FlowLaw grid_flow() {
    struct Grid {
        std::string array;
        OutsideGrid outside = OutsideGrid::clamp;
    };
    const Fields<Grid> fields = {
        {"file", ValueType::file, "VTK image file (.vti) with uncompressed point data.", kRequired},
        {"array", &Grid::array, "Name of the array, which must have three components.",
         Without{"the first array with three components"}},
        {"outside", &Grid::outside, "Velocity outside the grid.",
         Choices{choice(OutsideGrid::clamp, "clamp", "the value at the nearest point of the grid"),
                 choice(OutsideGrid::zero, "zero", "zero velocity")}}};
    return {variant("grid", "Samples on a regular grid with linear interpolation along each axis.", fields),
            [](const ObjectView& view, const SceneContext& context) -> FlowPointer {
                if (!view.has("file")) return nullptr;
                const Grid grid = view.read<Grid>();
                try {
                    VectorGrid samples = read_vti(context.file_of(view), grid.array);
                    context.add_memory(static_cast<double>(samples.values.size() * sizeof(Vec3)));
                    return make_grid_flow(std::move(samples), grid.outside);
                } catch (const InputError& problem) {
                    context.error(view, "file", problem.what());
                    return nullptr;
                }
            }};
}

const std::vector<FlowLaw>& flow_laws() {
    static const std::vector<FlowLaw> laws = {uniform_flow(), vortex_flow(),     radial_flow(), rotation_flow(),
                                              shear_flow(),   turbulence_flow(), sphere_flow(), grid_flow()};
    return laws;
}

}  // namespace

const ObjectSpec& flow_spec() {
    static ObjectSpec spec = object<FlowKeys>(
        "flow", "Velocity field of a fluid.",
        {{"factor", &FlowKeys::factor, kCoordinate, "", "Factor of the velocity."}}, variants_of(flow_laws()));
    // A sum consists of flows, so its entry refers to the whole table.
    static const bool closed = [] {
        spec.variants.push_back(variant<Unbound>("sum", "Sum of several flows.",
                                                 {{"parts", ValueType::list, "Flows whose velocities are added.",
                                                   kRequired, static_cast<const ObjectSpec*>(&spec)}}));
        return true;
    }();
    (void)closed;
    return spec;
}

ForceBuilder::ForceBuilder(const SceneContext& context) : context_(context) {
    for (const NamedObject& named : context.root().named_objects("flows")) flows_[named.name] = flow(named.view);
}

FlowPointer ForceBuilder::flow_at(const ObjectView& view) const {
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

FlowPointer ForceBuilder::flow(const ObjectView& view) const {
    const FlowLaw* law = law_of(flow_laws(), view);
    FlowPointer flow = made(context_, view, [&]() -> FlowPointer {
        if (view.type() == "sum") return sum_of(view);
        return law == nullptr ? nullptr : law->make(view, context_);
    });
    const double factor = view.read<FlowKeys>().factor;
    return flow && factor != 1.0 ? make_scaled_flow(std::move(flow), factor) : flow;
}

FlowPointer ForceBuilder::sum_of(const ObjectView& view) const {
    std::vector<FlowPointer> parts;
    for (const ObjectView& part : view.objects("parts")) parts.push_back(flow(part));
    return std::find(parts.begin(), parts.end(), nullptr) == parts.end() ? make_flow_sum(std::move(parts)) : nullptr;
}

}  // namespace ricochet::detail
