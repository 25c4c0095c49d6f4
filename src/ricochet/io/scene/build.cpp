// The scene as a whole, and its parts that are plain settings: simulation, bounds, cameras and output.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ricochet/dynamics/flight.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

constexpr double kMostSteps = 1e12;

enum class Motion { forces, flow };

// What "simulation" says.
struct SimulationKeys : SimulationOptions {
    Motion motion = Motion::forces;
};

struct OutputKeys : OutputOptions {
    bool contacts = false;
};

constexpr Range kTolerance = between(kSmallestTolerance, kLargestCoordinate);

const ObjectSpec& tolerance_spec() {
    using T = ErrorTolerance;
    static const ObjectSpec spec =
        object<T>("tolerance", "What one sub-step of an adaptive integrator may be wrong by.",
                  {{"position", &T::position, kTolerance, "m", "Of the position, also between a sub-step's ends."},
                   {"velocity", &T::velocity, kTolerance, "m/s", "Of the velocity."}});
    return spec;
}

const ObjectSpec& rollback_spec() {
    using R = RollbackSettings;
    static const ObjectSpec spec = object<R>(
        "rollback", "Settings of the rollback response.",
        {{"time_tolerance", &R::time_tolerance, kPositive, "s", "How closely bisection brackets the time of contact."},
         {"global", &R::global,
          "The whole system goes back to the earliest contact, as in textbooks, and not each particle for itself. "
          "Costs grow with particles times contacts."}});
    return spec;
}

const ObjectSpec& project_spec() {
    static const ObjectSpec spec = object<ProjectSettings>(
        "project", "Settings of the project response.",
        {{"offset", &ProjectSettings::offset, kLength, "m",
          "Thickness of the layer on surfaces in which a particle counts as in contact, and to whose top it is put "
          "back."}});
    return spec;
}

const ObjectSpec& penalty_spec() {
    using P = PenaltySettings;
    static const ObjectSpec spec =
        object<P>("penalty", "Settings of the penalty response.",
                  {{"stiffness", &P::stiffness, kPositive, "N/m", "Spring constant of contacts.",
                    Without{"for each particle the one with which an undamped contact lasts contact_steps sub-steps"}},
                   {"contact_steps", &P::contact_steps, kPositive, "",
                    "Sub-steps that an undamped contact lasts, where no stiffness is given."},
                   {"substeps", &P::substeps, between(1, 1e6), "", "Equal parts that every step is cut into."},
                   {"friction_speed", &P::friction_speed, kPositive, "m/s",
                    "Friction grows linearly with the slip up to this speed."}});
    return spec;
}

Choices integrator_choices() {
    using I = IntegratorKind;
    return {
        choice(I::forward_euler, "straight lines; the velocity changes afterwards: first order"),
        choice(I::symplectic_euler, "the step's force first, then a straight line"),
        choice(I::implicit_euler,
               "the force of the step's end first, then a straight line: first order, stable however stiff "
               "springs and forces are"),
        choice(I::ballistic, "a parabola: exact when the acceleration is constant"),
        choice(I::midpoint, "the explicit midpoint method: second order"),
        choice(I::velocity_verlet,
               "a parabola, then the mean of both ends' forces: second order, keeps energy bounded where forces "
               "depend on position only"),
        choice(I::rk4, "the classical Runge-Kutta method: fourth order"),
        choice(I::dormand_prince, "adaptive Runge-Kutta of order 5(4): each particle cuts the step by its own error")};
}

Choices response_choices() {
    using R = ResponseKind;
    return {choice(R::exact, "finds the time of impact and reflects inside the step"),
            choice(R::rollback, "finds a collision after the step and goes back to it"),
            choice(R::project, "tests at the end of the step and puts the particle back"),
            choice(R::penalty, "a spring and damper on the penetration")};
}

Choices motion_choices() {
    return {choice(Motion::forces, "forces", "the forces, by Newton's second law"),
            choice(Motion::flow, "flow",
                   "the flow that `flow` says carries them: their velocity is the flow's. Forces, materials and "
                   "responses other than `exact` have no part in it")};
}

Fields<SimulationKeys> time_fields() {
    using S = SimulationKeys;
    return {
        {"time_step", &S::time_step, kPositive, "s", "Length of a step."},
        {"duration", &S::duration, kNotNegative, "s",
         "Simulated time. The number of steps is ceil(duration / time_step - 1e-6), at least 1 where it is above 0; "
         "the last one ends there."},
        {"integrator", [](S& s) -> IntegratorKind& { return s.integrator.kind; },
         "How particles move inside a step. Of these only `forward_euler`, `midpoint`, `rk4` and `dormand_prince` have "
         "a meaning where a flow carries the particles.",
         integrator_choices(), Without{"`\"ballistic\"`; with `motion` `flow` it is `\"rk4\"`"}},
        {"tolerance", [](S& s) -> ErrorTolerance& { return s.integrator.tolerance; },
         "What one sub-step of dormand_prince may be wrong by.", &tolerance_spec(), Without{"its defaults"}},
        {"response", &S::response, "How impacts are answered.", response_choices()},
        {"motion", &S::motion, "What moves the particles.", motion_choices()},
        {"flow", ValueType::named_object,
         "What carries the particles where `motion` is `flow`: a flow, or the name of one in `flows`.", &flow_spec(),
         NamedIn{"flows"}, Without{"none"}},
        {"walls", &S::walls, "What happens to particles that the flow carries into a wall.",
         Choices{choice(WallRule::slide, "slide", "they go on along it"),
                 choice(WallRule::stop, "stop", "they stay there until the flow turns away")}}};
}

Fields<SimulationKeys> rule_fields() {
    using S = SimulationKeys;
    return {
        {"seed", &S::seed, kSeed, "", "Start of all random numbers: the same seed gives the same run, to the bit."},
        {"resting_speed", &S::resting_speed, kNotNegative, "m/s",
         "A rebound slower than this becomes resting or sliding contact, where the bounces lose energy and something "
         "presses the particle on."},
        {"frame_rate", &S::frame_rate, positive_up_to(1e6), "1/s",
         "Frames a second of emitters' rates per frame; neither the output's nor the time step's."},
        {"max_depth", &S::max_depth, kCount, "",
         "Highest generation of particles born of particles; births beyond are refused and counted."},
        {"most_particles", &S::most_particles, kCount, "",
         "Most particles alive at a time; births beyond are refused and counted. A fixed number, so that a run is the "
         "same "
         "on every machine; it must fit the memory all the same."},
        {"bounce_budget", &S::bounce_budget, between(1.0, 4294967295.0), "",
         "Most impacts of one particle in one step; beyond 64 intervals of contact every four count as one. A particle "
         "that spends it stays where it is for the rest of the step, and the time left out is counted."},
        {"rollback", &S::rollback, "Of the rollback response.", &rollback_spec(), Without{"its defaults"}},
        {"project", &S::project, "Of the project response.", &project_spec(), Without{"its defaults"}},
        {"penalty", &S::penalty, "Of the penalty response.", &penalty_spec(), Without{"its defaults"}}};
}

const ObjectSpec& simulation_spec() {
    static const ObjectSpec spec = object("simulation", "How time is stepped and how impacts are answered.",
                                          joined({time_fields(), rule_fields()}));
    return spec;
}

const ObjectSpec& bounds_spec() {
    static const ObjectSpec spec = object("bounds", "A box in world coordinates; particles that leave it are retired.",
                                          box_fields("Its corner with the largest coordinates, each above `lower`'s."));
    return spec;
}

const ObjectSpec& reference_camera_spec() {
    using C = ReferenceCamera;
    static const ObjectSpec spec = object<C>(
        "reference camera", "On whose screen emitters are measured; part of the scene, not of any picture.",
        {{"position", &C::position, kCoordinate, "m", "Where it stands.", kRequired},
         {"target", &C::target, kCoordinate, "m", "The point in the middle of its picture.", kRequired},
         {"field_of_view", &C::field_of_view_degrees, kFieldOfView, "degrees", kFieldOfViewMeaning},
         {"image_height", &C::image_height, between(1.0, 1e6), "", "Pixels from the lower to the upper edge."}});
    return spec;
}

const ObjectSpec& output_spec() {
    using O = OutputKeys;
    static const ObjectSpec spec = object<O>(
        "output", "What a run writes.",
        {{"format", &O::format, "Of the frames.",
          Choices{{"vtp", "VTK XML polygon data, with a .pvd index, for ParaView and Blender"}}},
         {"every", &O::every, between(1.0, 4294967295.0), "",
          "Steps from one frame to the next. The last state is always written."},
         {"checkpoint_every", &O::checkpoint_every, kCount, "",
          "Steps from one checkpoint to the next, each made with the frame that follows. An interrupted run leaves one "
          "in any case; `ricochet run --resume` goes on from it."},
         {"pieces", &O::pieces,
          "Each process of a run that several share writes its own part of the frames, with a .pvtp index over them, "
          "and "
          "of the checkpoints. Otherwise the first process gathers and writes them."},
         {"contacts", &O::contacts, "Write every impact, as points with their columns, once a frame."}});
    return spec;
}

Fields<Unbound> scene_fields() {
    constexpr std::string_view kDefaults = "all its defaults";
    return {
        {"ricochet", ValueType::integer, between(kSceneVersion, kSceneVersion), "", "Version of the scene format.",
         kRequired},
        {"$schema", ValueType::text, "For editors; not used here.", Without{"no help from the editor"}},
        {"simulation", ValueType::object, "Time and impacts.", &simulation_spec(), Without{kDefaults}},
        {"forces", ValueType::list, "Forces on the particles.", &force_spec()},
        {"particle_forces", ValueType::list, "Forces between the particles.", &particle_force_spec()},
        {"flows", ValueType::table, "Flows by name, for several forces to share.", &flow_spec()},
        {"materials", ValueType::table, "Materials by name.", &material_spec()},
        {"colliders", ValueType::list, "What particles bounce off.", &collider_spec()},
        {"frames", ValueType::table, "Moving frames of reference by name.", &frame_spec()},
        {"emitters", ValueType::list, "Where particles are born.", &emitter_spec()},
        {"particles", ValueType::list_or_file, "Particles that are there from the start, one by one or from a table.",
         &particle_spec()},
        {"springs", ValueType::list, "Springs between particles; ropes, chains and cloth with particles of their own.",
         &springs_spec()},
        {"particle_contacts", ValueType::object, "Spheres meet each other.", &particle_contacts_spec(),
         Without{"they pass through each other"}},
        {"heat", ValueType::object, "What changes the temperature of particles.", &heat_spec(),
         Without{"nothing but curves over life"}},
        {"attributes", ValueType::table, "Values of your own that particles carry, by name.", &attribute_spec()},
        {"reference_camera", ValueType::object, "For emitters' rates per screen area.", &reference_camera_spec(),
         Without{"no such rates"}},
        {"bounds", ValueType::object, "Where particles are retired.", &bounds_spec(), Without{"nowhere"}},
        {"output", ValueType::object, "What is written.", &output_spec(), Without{kDefaults}},
        {"camera", ValueType::object, "For pictures.", &camera_spec(), Without{"a camera that sees everything"}},
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

// First-order motion: the flow that carries the particles, and what does not go with it.
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
    if (!context.objects("forces").empty()) {
        context.error(context.root(), "forces", "a flow carries the particles, forces would do nothing: expected none");
    }
    if (!context.objects("springs").empty()) {
        context.error(context.root(), "springs",
                      "a flow carries the particles, springs would do nothing: expected none");
    }
}

/// What is carried has no momentum that walls could take, or share out.
void warn_of_walls_along_flows(const SceneContext& context, const SimulationSetup& setup) {
    if (setup.options.flow == nullptr) return;
    for (const NamedObject& named : context.root().named_objects("materials")) {
        if (!(named.view.read<Material>().absorption > 0.0)) continue;
        context.warn(named.view, "absorption", "a flow carries the particles, it does nothing: walls \"stop\" them");
    }
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        const auto& rule = setup.emitters[k].parent;
        if (!rule || !rule->share || rule->on != BirthEvent::impact) continue;
        context.warn(context.objects("emitters")[k], "on",
                     "a flow carries the particles, their impacts have no impulse and none is shared out: nothing is "
                     "born here; \"share\": false bears at every impact");
    }
}

void build_bounds(const SceneContext& context, SimulationSetup& setup) {
    const ObjectView view = context.root().object("bounds");
    if (!view.has("lower") || !view.has("upper")) return;
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
    if (!view.has("position") || !view.has("target")) return;
    setup.reference_camera = view.read<ReferenceCamera>();
    if (setup.reference_camera->position == setup.reference_camera->target) refuse_camera_on_target(context, view);
}

}  // namespace

const ObjectSpec& scene_spec() {
    static const ObjectSpec spec = object("scene", "A whole scene.", scene_fields());
    return spec;
}

Fields<Box3> box_fields(std::string_view upper_meaning) {
    return {{"lower", &Box3::lower, kCoordinate, "m", "Its corner with the smallest coordinates.", kRequired},
            {"upper", &Box3::upper, kCoordinate, "m", upper_meaning, kRequired}};
}

/// Groups of the colliders' triangles. What keeps a mesh from being read has been reported.
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
