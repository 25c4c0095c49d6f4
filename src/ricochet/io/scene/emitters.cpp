// Emitters of a scene.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

/// Local: a limit of input values.
// Largest number of births, because indices of particles are 32-bit numbers.
constexpr double kMostBirths = 4294967295.0;

// Keys of an emitter on a mesh, except the keys that select the mesh: a file or a collider.
struct MeshKeys {
    Placement placement;
    bool volume = false;
};

constexpr Range kRate = between(0.0, 1e12);

const ObjectSpec& rate_point_spec() {
    using P = RatePoint;
    static const ObjectSpec spec =
        object<P>("rate point", "A rate at a time.",
                  {{"time", &P::time, kCoordinate, "s", "Time, later than that of the point before.", kRequired},
                   {"rate", &P::rate, kRate, "1/s", "Particles per second at this time.", kRequired}});
    return spec;
}

Fields<EmitterDescription> schedule_fields() {
    using E = EmitterDescription;
    return {
        {"name", ValueType::text, "Unique name for messages and reports.",
         Without{"made from type and index in the list"}},
        {"burst", &E::burst, kCount, "", "Number of particles born at once at `start`."},
        {"rate", &E::rate, kRate, "1/s", "Particles per second from `start` to `stop`, drawn anew for every second."},
        {"rate_per_frame", &E::rate_per_frame, kRate, "",
         "Instead of `rate`: particles per frame of `simulation.frame_rate`, evenly spread over the frame. Drawn anew "
         "for every frame."},
        {"rate_per_area", &E::rate_per_area, kRate, "1/pixel",
         "Instead of `rate`: particles per frame and per pixel that the shape covers in the image of the "
         "`reference_camera`."},
        {"rate_curve", &E::rate_curve,
         "Instead of `rate`: particles per second over time, linear between the points and constant beyond them.",
         &rate_point_spec(), kTwoOrMore, Without{"`rate` applies"}},
        {"births", &E::spacing, "Times of the births of a rate.",
         Choices{choice(BirthSpacing::regular, "regular", "evenly spread"),
                 choice(BirthSpacing::poisson, "poisson", "random and independent, a Poisson process of this rate")}},
        {"start", &E::start, kNotNegative, "s", "Time at which it begins."},
        {"stop", &E::stop, kNotNegative, "s", "Time at which the rate ends.", Without{"never"}},
        {"limit", &E::limit, kCount, "", "Largest number of births in total. For type `child`: per parent.",
         Without{"no limit"}},
        {"seed", &E::seed, kSeed, "", "Seed of its own random numbers.",
         Without{"made from the scene's seed and the index in the list"}}};
}

Fields<EmitterDescription> launch_fields() {
    using E = EmitterDescription;
    return {
        {"direction", &E::direction, kCoordinate, "", "Launch direction.", kNotZero,
         Without{"the shape's own: the normal of a disk, sphere surface or mesh, the line from the tip of a cone, "
                 "otherwise any direction"}},
        {"cone", &E::cone_degrees, between(0.0, 180.0), "degrees",
         "Half angle of a cone about the direction, in which directions are drawn."},
        {"direction_law", &E::direction_law, "Distribution of the directions in the cone.",
         Choices{choice(DirectionLaw::uniform, "uniform", "uniform in solid angle"),
                 choice(DirectionLaw::cosine, "cosine",
                        "in proportion to the cosine of the angle to the direction; the default of `cone` is then "
                        "90")}},
        {"speed", &E::speed, kCoordinate, "m/s", "Speed along the direction.", &distribution_spec()},
        {"thermal", &E::thermal, "Thermal velocities, instead of `speed`, `cone` and `direction_law`.", &thermal_spec(),
         Without{"`speed` applies"}},
        {"velocity", &E::velocity, kCoordinate, "m/s", "Velocity added to direction times speed."},
    };
}

Fields<EmitterDescription> frame_fields() {
    return {{"frame", ValueType::text,
             "Name of a frame in `frames`. Shape, direction and velocity are in its coordinates. Particles also get "
             "the frame's velocity at the time and position of their birth.",
             Without{"the world"}}};
}

Variant mesh_variant() {
    return variant("mesh",
                   "Uniform by area on a mesh, launched along the normals of its triangles. Positions are just off the "
                   "surface, on the side of the normals.",
                   joined<MeshKeys>(
                       {{{"file", ValueType::file, kMeshFileMeaning},
                         {"collider", ValueType::text, "Name of a mesh collider. Its surface and its frame are used."}},
                        {up_field<MeshKeys>(Needs{"file"})},
                        placement_fields(&MeshKeys::placement, Needs{"file"}),
                        {{"volume", &MeshKeys::volume,
                          "true: uniform in the inside, launched in any direction. The mesh must be closed."}}}),
                   {"file", "collider"});
}

std::vector<Variant> emitter_shapes() {
    std::vector<Variant> all = simple_shapes();
    all.insert(all.end() - 1, mesh_variant());
    all.push_back(child_variant());
    return all;
}

const MeshShape* mesh_collider(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view) {
    const std::string name = view.text("collider");
    std::vector<std::string_view> names;
    for (const ColliderDescription& collider : setup.colliders) {
        const auto* mesh = std::get_if<MeshShape>(&collider.shape);
        if (mesh == nullptr) continue;
        names.push_back(collider.name);
        if (collider.name != name) continue;
        if (!mesh->motion) return mesh;
        context.error(view, "collider",
                      fmt::format("'{}' is a mesh that deforms, expected one that keeps its shape", name));
        return nullptr;
    }
    context.error(view, "collider", unknown_name("mesh collider", name, names));
    return nullptr;
}

// Returns the mesh of an emitter in world coordinates. Returns a null pointer after reporting an error.
std::shared_ptr<const TriangleMesh> surface_of(SceneContext& context, const SimulationSetup& setup,
                                               const ObjectView& view) {
    if (view.has("collider") && view.has("file")) return nullptr;  // reported already
    const bool is_collider = view.has("collider");
    std::shared_ptr<const TriangleMesh> mesh;
    Placement placement;
    if (!is_collider) {
        mesh = context.load_mesh(view);
        placement = view.read<MeshKeys>().placement;
    } else if (const MeshShape* collider = mesh_collider(context, setup, view)) {
        mesh = collider->mesh;
        placement = collider->placement;
    }
    if (!mesh) return nullptr;
    const char* key = is_collider ? "collider" : "file";
    const auto world = context.placed_mesh(view, key, *mesh, placement);
    if (world && !(surface_area(*world) > 0.0)) context.error(view, key, "the mesh has no area to emit from");
    return world;
}

EmitterShape shape_of(SceneContext& context, const SimulationSetup& setup, const ObjectView& view) {
    if (view.type() == "child") return view.has("cloud") ? simple_shape_of(view.object("cloud")) : PointShape{};
    if (view.type() != "mesh") return simple_shape_of(view);
    const auto surface = surface_of(context, setup, view);
    if (view.read<MeshKeys>().volume) return MeshVolumeShape{surface};
    return MeshSurfaceShape{surface};
}

// Returns true unless the mesh of the shape was refused.
bool is_measurable(const EmitterShape& shape) {
    const auto* const surface = std::get_if<MeshSurfaceShape>(&shape);
    const auto* const volume = std::get_if<MeshVolumeShape>(&shape);
    return (surface == nullptr || surface->mesh) && (volume == nullptr || volume->mesh);
}

constexpr const char* kNoEmitterOnBody =
    "impulses of particles move this body, and where it will be within a step is not known at the births; expected an "
    "emitter in the world or in a frame that moves by itself";

// Attaches the emitter to the frame of its key "frame", or to the frame of its collider.
void attach(const SceneContext& context, const ObjectView& view, const SimulationSetup& setup,
            EmitterDescription& emitter) {
    const bool is_on_collider = view.type() == "mesh" && view.has("collider");
    const bool has_frame = view.has("frame");
    std::optional<std::size_t> frame;
    if (has_frame && is_on_collider) {
        context.error(view, "frame",
                      "the emitter is in its collider's frame, expected an emitter of another kind or a file");
    } else if (has_frame && view.type() == "child") {
        context.error(view, "frame",
                      "children are born at the positions of their parents, expected an emitter of another kind, or a "
                      "\"cloud\", which follows its parent");
    } else if (has_frame) {
        if (is_frame_named(context, view, *setup.frames)) frame = setup.frames->find(view.text("frame"));
    } else if (is_on_collider) {
        const auto collider = std::find_if(setup.colliders.begin(), setup.colliders.end(),
                                           [&](const auto& other) { return other.name == view.text("collider"); });
        if (collider != setup.colliders.end()) frame = setup.frames->find(collider->frame);
    }
    if (!frame) return;
    if (setup.frames->description(*frame).is_driven) {
        context.error(view, has_frame ? "frame" : "collider", kNoEmitterOnBody);
        return;
    }
    emitter.frames = setup.frames;
    emitter.frame = *frame;
    if (has_frame && !context.failed() && setup.frames->is_scaled(emitter.frame)) {
        context.error(view, "frame",
                      "the frame is scaled, but particles keep their size; expected a frame without a \"scale\", also "
                      "in the frames that it stands on");
    }
}

double most_of(const MeanSpread& rate) { return rate.mean + rate.spread; }

// Returns the largest possible number of births per second. Reports contradictory rates.
double most_rate(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view,
                 const EmitterDescription& emitter) {
    const double per_area = most_of(emitter.rate_per_area);
    const int rates = (most_of(emitter.rate) > 0.0) + (most_of(emitter.rate_per_frame) > 0.0) + (per_area > 0.0) +
                      !emitter.rate_curve.empty();
    if (rates > 1) {
        const char* const key = !emitter.rate_curve.empty()             ? "rate_curve"
                                : most_of(emitter.rate_per_frame) > 0.0 ? "rate_per_frame"
                                                                        : "rate_per_area";
        context.error(view, key,
                      "the emitter has another rate already, expected one of rate, rate_per_frame, rate_per_area and "
                      "rate_curve");
    }
    double per_frame = most_of(emitter.rate_per_frame);
    if (per_area > 0.0 && !setup.reference_camera) {
        context.error(view, "rate_per_area", "only goes together with the scene's \"reference_camera\"");
    } else if (per_area > 0.0 && is_measurable(emitter.shape)) {
        try {
            per_frame += per_area * screen_area(emitter.shape, *setup.reference_camera);
        } catch (const InputError& problem) {
            context.error(view, "rate_per_area", problem.what());
        }
    }
    return most_of(emitter.rate) + per_frame * setup.options.frame_rate;
}

bool has_rate(const EmitterDescription& emitter, double most) { return most > 0.0 || !emitter.rate_curve.empty(); }

// Reports a curve whose times do not increase, and removes it.
void check_curve(const SceneContext& context, const ObjectView& view, EmitterDescription& emitter) {
    const std::vector<ObjectView> points = view.objects("rate_curve");
    for (std::size_t k = 1; k < points.size(); ++k) {
        if (emitter.rate_curve[k - 1].time < emitter.rate_curve[k].time) continue;
        context.error(points[k], "time",
                      fmt::format("found {} s, expected a time after that of the point before ({} s)",
                                  emitter.rate_curve[k].time, emitter.rate_curve[k - 1].time));
        emitter.rate_curve.clear();
        return;
    }
}

// Reports contradictory settings. Returns the largest possible number of births.
double checked_births(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view,
                      const EmitterDescription& emitter) {
    const double duration = setup.options.duration;
    if (emitter.stop < emitter.start) {
        context.error(view, "stop",
                      fmt::format("found {} s, expected a time after start ({} s)", emitter.stop, emitter.start));
    }
    const double most = most_rate(context, setup, view, emitter);
    const double time = std::max(0.0, std::min(duration, emitter.stop) - emitter.start);
    const double by_rate = most * time + births_of_curve(emitter.rate_curve, emitter.start, emitter.start + time);
    const double births = static_cast<double>(emitter.burst) + by_rate;
    if (view.has("births") && emitter.spacing == BirthSpacing::poisson && by_rate == 0.0 && emitter.burst > 0) {
        context.warn(view, "births", "has no effect: the emitter has only a burst and no rate");
    }
    if ((emitter.burst == 0 && by_rate == 0.0 && time > 0.0) || (emitter.burst == 0 && !has_rate(emitter, most)) ||
        emitter.limit == 0) {
        context.warn(view, "emits nothing: it has neither a burst nor a rate");
    } else if (emitter.start >= duration) {
        context.warn(view, "start",
                     fmt::format("emits nothing: it begins at {} s, the scene ends at {} s", emitter.start, duration));
    }
    return std::min(births, static_cast<double>(emitter.limit));
}

// Reports mesh volumes in which no positions can be drawn, at the key of the mesh.
void check_volume(const SceneContext& context, const ObjectView& view, const EmitterShape& shape) {
    const auto* const volume = std::get_if<MeshVolumeShape>(&shape);
    if (volume == nullptr || volume->mesh == nullptr) return;
    try {
        const ShapeSampler sampler(shape);
    } catch (const InputError& problem) {
        context.error(view, view.has("collider") ? "collider" : "file", problem.what());
    }
}

}  // namespace

const ObjectSpec& emitter_spec() {
    static const ObjectSpec spec =
        object("emitter", "A source of particles. A pair [mean, spread] is drawn anew for every particle.",
               joined({schedule_fields(), launch_fields(), body_fields(), frame_fields(), emitter_look_fields()}),
               emitter_shapes());
    return spec;
}

void build_emitters(SceneContext& context, SimulationSetup& setup) {
    std::set<std::string> taken;
    double births = 0.0;
    for (const ObjectView& view : context.objects("emitters")) {
        auto emitter = view.read<EmitterDescription>();
        emitter.name = context.unique_name(view, setup.emitters.size(), "emitter", taken);
        emitter.shape = shape_of(context, setup, view);
        attach(context, view, setup, emitter);
        check_volume(context, view, emitter.shape);
        read_looks(context, setup, view, emitter);
        if (view.type() == "child") {
            emitter.parent = rule_of(context, view, emitter);
        } else {
            check_curve(context, view, emitter);
            births += checked_births(context, setup, view, emitter);
        }
        check_launch(context, view, emitter);
        if (births > kMostBirths) {
            context.error(
                view, fmt::format("with this emitter the scene gives birth to {:.3g} particles, expected at most {}",
                                  births, kMostBirths));
        }
        setup.emitters.push_back(std::move(emitter));
    }
    check_parents(context, setup);
}

}  // namespace ricochet::detail
