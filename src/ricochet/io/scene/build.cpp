// Builds the whole scene, and its simple settings: simulation, bounds, cameras and output.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ricochet/dynamics/flight.h"
#include "ricochet/io/scene/context.h"
#include "ricochet/response/settings_table.h"
#include "ricochet/simulation/options_table.h"

namespace ricochet::detail {
namespace {

enum class Motion { forces, flow };

// Values of the key "simulation".
struct SimulationKeys : SimulationOptions {
    Motion motion = Motion::forces;
};

struct OutputKeys : OutputOptions {
    bool contacts = false;
};

// Returns the table of an object whose keys are the settings of a struct.
template <class Settings>
const ObjectSpec& settings_spec(std::string_view title, std::string_view description, const auto& settings) {
    static const ObjectSpec spec = object(title, description, fields_of<Settings>(settings));
    return spec;
}

Choices integrator_choices() {
    using I = IntegratorKind;
    return {choice(I::forward_euler, "a straight line, then the change of velocity: first order"),
            choice(I::symplectic_euler, "the change of velocity, then a straight line: first order"),
            choice(I::implicit_euler,
                   "the change of velocity by the force at the end of the step, then a straight line: first order, "
                   "stable for any stiffness"),
            choice(I::ballistic, "a parabola: exact for constant acceleration"),
            choice(I::midpoint, "the explicit midpoint method: second order"),
            choice(I::velocity_verlet,
                   "a parabola, then the mean of the forces at both ends: second order, bounded energy if forces "
                   "depend on position only"),
            choice(I::rk4, "the classical Runge-Kutta method: fourth order"),
            choice(I::dormand_prince,
                   "adaptive Runge-Kutta of order 5(4): each particle chooses its sub-steps by its own error")};
}

Choices response_choices() {
    using R = ResponseKind;
    return {choice(R::exact, "finds the time of impact and reflects inside the step"),
            choice(R::rollback, "detects a collision after the step and goes back to it"),
            choice(R::project, "tests at the end of the step and moves the particle back"),
            choice(R::penalty, "a spring and damper on the penetration depth")};
}

Choices motion_choices() {
    return {choice(Motion::forces, "forces", "the forces, by Newton's second law"),
            choice(Motion::flow, "flow",
                   "the flow of the key `flow`: particles have its velocity. Forces, materials and responses other "
                   "than `exact` do not apply")};
}

Fields<SimulationKeys> choice_fields() {
    using S = SimulationKeys;
    return {{"integrator", [](S& s) -> IntegratorKind& { return s.integrator.kind; },
             "Method that moves particles inside a step. If a flow carries the particles, only `forward_euler`, "
             "`midpoint`, `rk4` and `dormand_prince` are allowed.",
             integrator_choices(), Without{"`\"ballistic\"`; with `motion` `flow` it is `\"rk4\"`"}},
            {"tolerance", [](S& s) -> ErrorTolerance& { return s.integrator.tolerance; },
             "Largest error of one sub-step of `dormand_prince`.",
             &settings_spec<ErrorTolerance>("tolerance", "Largest error of one sub-step of an adaptive integrator.",
                                            kToleranceTable),
             Without{"its defaults"}},
            {"response", &S::response, "Method that handles impacts.", response_choices()},
            {"motion", &S::motion, "Cause of the particles' motion.", motion_choices()},
            {"flow", ValueType::named_object,
             "Flow that carries the particles if `motion` is `flow`: a flow, or the name of one in `flows`.",
             &flow_spec(), NamedIn{"flows"}, Without{"none"}},
            {"walls", &S::walls, "Behaviour of particles that the flow carries into a wall.",
             Choices{choice(WallRule::slide, "slide", "they slide along it"),
                     choice(WallRule::stop, "stop", "they stay there until the flow turns away")}}};
}

Fields<SimulationKeys> response_fields() {
    using S = SimulationKeys;
    constexpr std::string_view kRollback = "Settings of the rollback response.";
    constexpr std::string_view kProject = "Settings of the project response.";
    constexpr std::string_view kPenalty = "Settings of the penalty response.";
    constexpr Without kDefaults{"its defaults"};
    return {{"rollback", &S::rollback, kRollback,
             &settings_spec<RollbackSettings>("rollback", kRollback, kRollbackTable), kDefaults},
            {"project", &S::project, kProject, &settings_spec<ProjectSettings>("project", kProject, kProjectTable),
             kDefaults},
            {"penalty", &S::penalty, kPenalty, &settings_spec<PenaltySettings>("penalty", kPenalty, kPenaltyTable),
             kDefaults}};
}

const ObjectSpec& simulation_spec() {
    static const ObjectSpec spec = object("simulation", "Time steps and the handling of impacts.",
                                          joined({fields_of<SimulationKeys>(kTimeTable), choice_fields(),
                                                  fields_of<SimulationKeys>(kRulesTable), response_fields()}));
    return spec;
}

const ObjectSpec& bounds_spec() {
    static const ObjectSpec spec =
        object("bounds", "A box in world coordinates. Particles that leave it are retired.",
               box_fields("Corner with the largest coordinates. Each is above that of `lower`."));
    return spec;
}

const ObjectSpec& reference_camera_spec() {
    using C = ReferenceCamera;
    static const ObjectSpec spec =
        object<C>("reference camera",
                  "Camera whose image defines emitter rates per pixel. It is part of the scene, not of any picture.",
                  {{"position", &C::position, kCoordinate, "m", "Position of the camera.", kRequired},
                   {"target", &C::target, kCoordinate, "m", "Point in the middle of its image.", kRequired},
                   {"field_of_view", &C::field_of_view_degrees, kFieldOfView, "degrees", kFieldOfViewMeaning},
                   {"image_height", &C::image_height, between(1.0, 1e6), "", "Height of the image, in pixels."}});
    return spec;
}

const ObjectSpec& output_spec() {
    using O = OutputKeys;
    static const ObjectSpec spec = object<O>(
        "output", "Files that a run writes.",
        {{"format", &O::format, "File format of the frames.",
          Choices{{"vtp", "VTK XML polygon data, with a .pvd index, for ParaView and Blender"}}},
         {"every", &O::every, between(1.0, 4294967295.0), "",
          "Steps from one frame to the next. The last state is always written."},
         {"checkpoint_every", &O::checkpoint_every, kCount, "",
          "Steps from one checkpoint to the next. Each is written together with the next frame. An interrupted run "
          "always leaves a checkpoint, from which `ricochet run --resume` continues."},
         {"pieces", &O::pieces,
          "true: each process of a shared run writes its own part of the frames and checkpoints, with a .pvtp index "
          "for the frames. false: the first process gathers and writes them."},
         {"contacts", &O::contacts, "true: the run writes every impact as a point with its columns, once per frame."}});
    return spec;
}

Fields<Unbound> scene_fields() {
    constexpr std::string_view kDefaults = "all its defaults";
    return {
        {"ricochet", ValueType::integer, between(kSceneVersion, kSceneVersion), "", "Version of the scene format.",
         kRequired},
        {"$schema", ValueType::text, "Schema for editors. Ricochet ignores it.", Without{"no help from the editor"}},
        {"simulation", ValueType::object, "Time steps and impacts.", &simulation_spec(), Without{kDefaults}},
        {"forces", ValueType::list, "Forces on the particles.", &force_spec()},
        {"particle_forces", ValueType::list, "Forces between the particles.", &particle_force_spec()},
        {"flows", ValueType::table, "Flows by name, which several forces can share.", &flow_spec()},
        {"materials", ValueType::table, "Materials by name.", &material_spec()},
        {"colliders", ValueType::list, "Surfaces that particles bounce off.", &collider_spec()},
        {"frames", ValueType::table, "Moving frames of reference by name.", &frame_spec()},
        {"emitters", ValueType::list, "Sources of particles.", &emitter_spec()},
        {"particles", ValueType::list_or_file, "Particles that exist from the start, one by one or from a table.",
         &particle_spec()},
        {"springs", ValueType::list,
         "Springs between particles, and ropes, chains and cloth with particles of their own.", &springs_spec()},
        {"particle_contacts", ValueType::object, "Contacts between spheres.", &particle_contacts_spec(),
         Without{"spheres pass through each other"}},
        {"heat", ValueType::object, "Processes that change the temperature of particles.", &heat_spec(),
         Without{"only curves over life change it"}},
        {"attributes", ValueType::table, "User-defined values of particles, by name.", &attribute_spec()},
        {"reference_camera", ValueType::object, "Camera for emitter rates per screen area.", &reference_camera_spec(),
         Without{"no such rates"}},
        {"bounds", ValueType::object, "Box outside which particles are retired.", &bounds_spec(), Without{"no box"}},
        {"counters", ValueType::list, "Surfaces that count the particles that pass them.", &counter_spec()},
        {"output", ValueType::object, "Files that a run writes.", &output_spec(), Without{kDefaults}},
        {"camera", ValueType::object, "Camera of pictures.", &camera_spec(), Without{"a camera that sees everything"}},
        {"picture", ValueType::object, "Light and surroundings of pictures.", &picture_spec(), Without{"a clear day"}}};
}

void build_simulation(const SceneContext& context, SimulationOptions& options) {
    const ObjectView view = context.root().object("simulation");
    options = view.read<SimulationKeys>();
    const double steps = options.duration / options.time_step;
    if (steps > kMostSteps) {
        context.error(view, "time_step",
                      fmt::format("{} s in {} s is {:.3g} steps, expected at most {}", options.time_step,
                                  options.duration, steps, kMostSteps));
    }
}

// Reads the settings of first-order motion. Sets the flow that carries the particles, and reports settings that do not
// apply.
void build_motion(const SceneContext& context, const ForceBuilder& forces, SimulationOptions& options) {
    const ObjectView view = context.root().object("simulation");
    const FlowPointer flow = forces.flow_at(view);
    if (view.read<SimulationKeys>().motion != Motion::flow) {
        for (const char* key : {"flow", "walls"}) {
            if (view.has(key)) context.error(view, key, "only goes together with \"motion\": \"flow\"");
        }
        return;
    }
    options.flow = flow;
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
    for (const char* key : {"forces", "springs"}) {
        if (context.objects(key).empty()) continue;
        context.error(context.root(), key,
                      fmt::format("a flow carries the particles, {} would do nothing: expected none", key));
    }
}

/// Warns of wall settings that have no effect if a flow carries the particles. Such particles have no momentum that
/// walls could absorb or share.
void warn_of_walls_along_flows(const SceneContext& context, const SimulationSetup& setup) {
    if (setup.options.flow == nullptr) return;
    for (const NamedObject& named : context.root().named_objects("materials")) {
        if (!(named.view.read<Material>().absorption > 0.0)) continue;
        context.warn(named.view, "absorption",
                     "a flow carries the particles, so this key has no effect: walls \"stop\" them");
    }
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        const auto& rule = setup.emitters[k].parent;
        if (!rule || !rule->share || rule->on != BirthEvent::impact) continue;
        context.warn(context.objects("emitters")[k], "on",
                     "a flow carries the particles, so impacts have no impulse and no parent is shared out: this "
                     "emitter never emits; with \"share\": false it emits at every impact");
    }
}

void build_bounds(const SceneContext& context, SimulationSetup& setup) {
    const ObjectView view = context.root().object("bounds");
    if (!view.is_complete()) return;
    const Box3 box = view.read<Box3>();
    for (int axis = 0; axis < 3; ++axis) {
        if (box.lower[axis] < box.upper[axis]) continue;
        context.error(
            view, "upper",
            fmt::format("found {} = {}, expected more than lower's {}", "xyz"[axis], box.upper[axis], box.lower[axis]));
    }
    setup.bounds = box;
}

void build_reference_camera(const SceneContext& context, SimulationSetup& setup) {
    const ObjectView view = context.root().object("reference_camera");
    if (!view.is_complete()) return;
    setup.reference_camera = view.read<ReferenceCamera>();
    if (setup.reference_camera->position == setup.reference_camera->target) refuse_camera_on_target(context, view);
}

}  // namespace

const ObjectSpec& scene_spec() {
    static const ObjectSpec spec = object("scene", "A whole scene.", scene_fields());
    return spec;
}

Fields<Box3> box_fields(std::string_view upper_meaning) {
    return {{"lower", &Box3::lower, kCoordinate, "m", "Corner with the smallest coordinates.", kRequired},
            {"upper", &Box3::upper, kCoordinate, "m", upper_meaning, kRequired}};
}

/// Returns the triangle groups of every collider. Errors of the mesh files have already been reported.
static std::vector<TriangleGroups> groups_of_colliders(SceneContext& context) {
    std::vector<TriangleGroups> groups;
    for (const ObjectView& view : context.objects("colliders")) {
        const MeshGroups* const found = view.type() == "mesh" ? context.load_groups(view) : nullptr;
        groups.push_back(found == nullptr ? TriangleGroups{} : triangle_groups(*found));
    }
    return groups;
}

SceneDescription build_scene(const JsonNode& root, const std::filesystem::path& folder, Diagnostics& diagnostics) {
    SceneContext context(root, folder, diagnostics);
    SceneDescription scene;
    const ForceBuilder forces(context);
    build_simulation(context, scene.setup.options);
    build_motion(context, forces, scene.setup.options);
    scene.setup.forces = forces.forces();
    build_bounds(context, scene.setup);
    std::vector<FrameDescription> frames = frames_of(context);
    build_colliders(context, scene.setup, frames);
    scene.groups = groups_of_colliders(context);
    build_bodies(context, scene.setup, frames);
    scene.setup.frames = std::make_shared<const FrameTree>(std::move(frames));
    read_particle_contacts(context, scene.setup.options);
    build_attributes(context, scene.setup);
    build_reference_camera(context, scene.setup);
    build_emitters(context, scene.setup);
    warn_of_walls_along_flows(context, scene.setup);
    build_particles(context, scene.setup);
    build_springs(context, scene.setup);
    check_particle_contacts(context, scene.setup);
    build_particle_forces(context, scene.setup);
    check_clouds(context, scene.setup);
    build_heat(context, forces, scene.setup);
    build_counters(context, scene.setup);
    warn_of_forces_on_nobody(context, scene.setup);
    warn_of_forces_without_radius(context, scene.setup);
    const auto output = context.root().object("output").read<OutputKeys>();
    scene.output = output;
    scene.setup.options.record_contacts = output.contacts;
    build_pictures(context, scene);
    if (scene.setup.particles.empty() && scene.setup.emitters.empty() && scene.setup.bodies.empty()) {
        diagnostics.warning({}, "", "the scene has neither emitters nor particles, nothing will move");
    }
    scene.files = context.files();
    check_memory(context, scene);
    return scene;
}

}  // namespace ricochet::detail
