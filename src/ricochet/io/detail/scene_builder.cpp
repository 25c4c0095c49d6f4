#include "ricochet/io/detail/scene_builder.h"

#include <fmt/format.h>

#include <utility>

#include "ricochet/io/detail/attribute_keys.h"
#include "ricochet/io/detail/object_view.h"
#include "ricochet/io/detail/scene_context.h"

namespace ricochet::detail {
namespace {

constexpr double kMostSteps = 1e12;

void build_response(const ObjectView& simulation, SimulationOptions& options) {
    const ObjectView rollback = simulation.object("rollback");
    options.rollback = {rollback.number("time_tolerance"), rollback.boolean("global")};
    options.project = {simulation.object("project").number("offset")};
    const ObjectView penalty = simulation.object("penalty");
    if (penalty.has("stiffness")) options.penalty.stiffness = penalty.number("stiffness");
    options.penalty.contact_steps = penalty.number("contact_steps");
    options.penalty.substeps = static_cast<std::uint32_t>(penalty.whole_number("substeps"));
    options.penalty.friction_speed = penalty.number("friction_speed");
}

void build_simulation(const SceneContext& context, SimulationOptions& options) {
    const ObjectView view = context.root().object("simulation");
    options.time_step = view.number("time_step");
    options.duration = view.number("duration");
    options.integrator.kind = integrator_from_name(view.text("integrator")).value_or(options.integrator.kind);
    const ObjectView tolerance = view.object("tolerance");
    options.integrator.tolerance = {tolerance.number("position"), tolerance.number("velocity")};
    options.seed = view.whole_number("seed");
    options.resting_speed = view.number("resting_speed");
    options.bounce_budget = static_cast<std::uint32_t>(view.whole_number("bounce_budget"));
    options.frame_rate = view.number("frame_rate");
    options.max_depth = static_cast<std::uint32_t>(view.whole_number("max_depth"));
    options.most_particles = view.whole_number("most_particles");
    options.response = response_from_name(view.text("response")).value_or(options.response);
    build_response(view, options);
    const double steps = options.duration / options.time_step;
    if (steps > kMostSteps) {
        context.error(view, "time_step",
                      fmt::format("{} s in {} s is {:.3g} steps, expected at most {}", options.time_step,
                                  options.duration, steps, kMostSteps));
    }
}

void build_bounds(const SceneContext& context, SimulationSetup& setup) {
    if (!context.root().has("bounds")) return;
    const ObjectView view = context.root().object("bounds");
    if (!view.has("lower") || !view.has("upper")) return;
    Box3 box;
    box.lower = view.vector("lower");
    box.upper = view.vector("upper");
    for (int axis = 0; axis < 3; ++axis) {
        if (box.lower[axis] < box.upper[axis]) continue;
        context.error(
            view, "upper",
            fmt::format("found {} = {}, expected more than lower's {}", "xyz"[axis], box.upper[axis], box.lower[axis]));
    }
    setup.bounds = box;
}

void build_reference_camera(const SceneContext& context, SimulationSetup& setup) {
    if (!context.root().has("reference_camera")) return;
    const ObjectView view = context.root().object("reference_camera");
    if (!view.has("position") || !view.has("target")) return;
    setup.reference_camera = ReferenceCamera{view.vector("position"), view.vector("target"),
                                             view.number("field_of_view"), view.number("image_height")};
    if (view.vector("position") == view.vector("target")) {
        context.error(view, "target", "the camera stands on its target, expected another point");
    }
}

CameraDescription camera_of(const SceneContext& context, const ObjectView& view) {
    constexpr double kSmallestSine = 1e-6;  // of the angle between the view and up
    CameraDescription camera;
    camera.position = view.vector("position");
    camera.target = view.vector("target");
    camera.field_of_view_degrees = view.number("field_of_view");
    if (view.has("up")) camera.up = view.vector("up");
    if (!view.has("position") || !view.has("target")) return camera;
    const Vec3 ahead = camera.target - camera.position;
    if (ahead == Vec3{}) {
        context.error(view, "target", "the camera stands on its target, expected another point");
    } else if (camera.up && length(cross(normalized(*camera.up), normalized(ahead))) < kSmallestSine) {
        context.error(view, "up", "the camera looks along its up direction, expected another one");
    }
    return camera;
}

}  // namespace

SceneDescription build_scene(const JsonNode& root, const std::filesystem::path& folder, Diagnostics& diagnostics) {
    SceneContext context(root, folder, diagnostics);
    SceneDescription scene;
    build_simulation(context, scene.setup.options);
    build_forces(context, scene.setup);
    build_bounds(context, scene.setup);
    build_colliders(context, scene.setup);
    build_attributes(context, scene.setup);
    build_reference_camera(context, scene.setup);
    build_emitters(context, scene.setup);
    build_particles(context, scene.setup);
    build_springs(context, scene.setup);
    warn_of_forces_without_radius(context, scene.setup);
    const ObjectView output = context.root().object("output");
    scene.output = {output.text("format"), output.whole_number("every")};
    scene.setup.options.record_contacts = output.boolean("contacts");
    if (context.root().has("camera")) scene.camera = camera_of(context, context.root().object("camera"));
    if (scene.setup.particles.empty() && scene.setup.emitters.empty()) {
        diagnostics.warning({}, "", "the scene has neither emitters nor particles, nothing will move");
    }
    return scene;
}

}  // namespace ricochet::detail
