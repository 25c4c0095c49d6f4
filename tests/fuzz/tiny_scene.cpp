#include "fuzz/tiny_scene.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "fuzz/tiny_movers.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"
#include "support/simple_meshes.h"

namespace ricochet::fuzz {
namespace {

using MeshPointer = std::shared_ptr<const TriangleMesh>;

// An expression outside of braces draws at most once, because compilers evaluate operands and arguments in different
// orders.

/// Returns triangles between points selected by the bytes. They may intersect, repeat and have no area.
MeshPointer any_triangles(ByteChoices& choices) {
    TriangleMesh mesh;
    const std::size_t vertices = 3 + choices.index(6);
    for (std::size_t k = 0; k < vertices; ++k) mesh.vertices.push_back(choices.point());
    const std::size_t triangles = 1 + choices.index(8);
    for (std::size_t k = 0; k < triangles; ++k) {
        Triangle& triangle = mesh.triangles.emplace_back();
        for (std::uint32_t& corner : triangle) corner = static_cast<std::uint32_t>(choices.index(vertices));
    }
    return std::make_shared<const TriangleMesh>(std::move(mesh));
}

/// Returns a sheet of 2 x 2 cells with heights selected by the bytes.
MeshPointer terrain(ByteChoices& choices) {
    TriangleMesh mesh;
    for (int k = 0; k < 9; ++k) mesh.vertices.emplace_back(k % 3 - 1, k / 3 - 1, 0.5 * choices.coordinate());
    for (const std::uint32_t corner : {0U, 1U, 3U, 4U}) {
        mesh.triangles.push_back({corner, corner + 1, corner + 4});
        mesh.triangles.push_back({corner, corner + 4, corner + 3});
    }
    return std::make_shared<const TriangleMesh>(std::move(mesh));
}

MeshPointer any_mesh(ByteChoices& choices) {
    const auto shared = [](TriangleMesh mesh) { return std::make_shared<const TriangleMesh>(std::move(mesh)); };
    switch (choices.index(6)) {
        case 0:
            return shared(testing::box_mesh({-1, -1, -1}, {1, 1, 1}));
        case 1:
            return shared(testing::sphere_mesh({}, 1.0, static_cast<int>(choices.index(3))));
        case 2:
            return shared(testing::flipped(testing::sphere_mesh({}, 1.0, 0)));
        case 3:
            return shared(testing::merged(testing::box_mesh({-1, -1, -1}, {1, 1, 1}),
                                          testing::box_mesh({-0.5, -0.5, 0}, {0.5, 0.5, 1})));
        case 4:
            return terrain(choices);
        default:
            return any_triangles(choices);
    }
}

Placement placement(ByteChoices& choices) {
    Placement result;
    if (choices.yes()) result.position = choices.point();
    if (choices.yes()) {
        result.rotation_axis = choices.direction();
        result.rotation_degrees = choices.yes() ? 45.0 * static_cast<double>(choices.index(8)) : 90.0 * choices.part();
    }
    if (choices.yes()) {
        for (const int axis : {0, 1, 2}) result.scale[axis] = choices.between(0.2, 1.6);
        if (choices.yes()) result.scale.x *= -1.0;
    }
    return result;
}

/// Returns one of four values, or a fraction of it.
double up_to(ByteChoices& choices, const double (&values)[4]) {
    const double most = choices.one_of(values);
    return choices.yes() ? most * choices.part() : most;
}

double length(ByteChoices& choices) {
    const double least = choices.one_of<double>({0.25, 0.5, 1.0, 1.75});
    return least + 0.2 * choices.part();
}

ColliderShape collider_shape(ByteChoices& choices) {
    switch (choices.index(5)) {
        case 0:
            return PlaneShape{choices.point(), choices.direction()};
        case 1:
            return BallShape{length(choices), placement(choices)};
        case 2:
            return CylinderShape{length(choices), length(choices), placement(choices)};
        case 3: {
            Vec3 size;
            for (const int axis : {0, 1, 2}) size[axis] = length(choices);
            return CuboidShape{size, placement(choices)};
        }
        default:
            return MeshShape{any_mesh(choices), placement(choices), ""};
    }
}

Material material(ByteChoices& choices, bool may_be_random) {
    Material result;
    result.restitution = up_to(choices, {0.0, 1.0, 0.5, 0.9});
    result.friction = up_to(choices, {0.0, 0.3, 1.0, 2.0});
    if (choices.yes()) result.rolling_friction = 0.2 * choices.part();
    if (choices.yes()) result.spinning_friction = 0.01 * choices.part();
    if (choices.yes()) result.restitution_threshold = choices.part();
    if (may_be_random && choices.yes()) {
        result.diffuse = choices.part();
        result.absorption = 0.3 * choices.part();
        if (choices.yes()) result.wall_temperature = 1.0 + 500.0 * choices.part();
    }
    return result;
}

FlowPointer flow(ByteChoices& choices) {
    switch (choices.index(6)) {
        case 0:
            return make_wind(choices.point());
        case 1:
            return make_vortex({.point = choices.point(), .axis = choices.direction(), .circulation = choices.part()});
        case 2: {
            const Vec3 center = choices.point();
            const double strength = choices.coordinate();
            return make_source(center, strength, 0.1 + choices.part());
        }
        case 3: {
            const Vec3 point = choices.point();
            return make_rotation(point, choices.point());
        }
        case 4: {
            const Vec3 center = choices.point();
            const Vec3 velocity = choices.point();
            return make_flow_past_sphere(center, 0.5 + choices.part(), velocity);
        }
        default:
            return make_turbulence({.seed = choices.byte(), .speed = 2.0 * choices.part(), .octaves = 2, .rate = 1.0});
    }
}

void add_forces(ByteChoices& choices, SimulationSetup& setup) {
    if (choices.yes()) setup.forces.push_back(make_gravity(choices.yes() ? Vec3{0, 0, -9.81} : 5.0 * choices.point()));
    if (choices.yes()) setup.forces.push_back(make_linear_drag(3.0 * choices.part()));
    if (choices.yes()) setup.forces.push_back(make_quadratic_drag(0.1, flow(choices)));
    if (choices.yes()) setup.forces.push_back(make_sphere_drag(0.47, 1.2, flow(choices)));
    if (!choices.yes()) return;
    const Vec3 center = choices.point();
    setup.forces.push_back(make_acceleration([center](const ForceInput& input) { return center - input.position; }));
}

void add_options(ByteChoices& choices, SimulationSetup& setup) {
    constexpr IntegratorKind kIntegrators[] = {
        IntegratorKind::ballistic,        IntegratorKind::forward_euler, IntegratorKind::midpoint,
        IntegratorKind::symplectic_euler, IntegratorKind::rk4,           IntegratorKind::velocity_verlet,
        IntegratorKind::dormand_prince,   IntegratorKind::implicit_euler};
    SimulationOptions& options = setup.options;
    options.integrator = {choices.one_of(kIntegrators), {1e-4, 1e-4}};
    options.response = choices.yes() ? ResponseKind::exact : response_kinds()[choices.index(response_kinds().size())];
    options.rollback.global = choices.yes();
    options.time_step = choices.one_of<double>({1.0 / 60.0, 1e-3, 0.05, 0.1});
    options.duration = options.time_step * static_cast<double>(kTinySteps);
    options.resting_speed = choices.one_of<double>({1e-3, 0.0, 0.05});
    options.bounce_budget = choices.one_of<std::uint32_t>({20, 1, 3});
    // The global rollback repeats the step of all particles for each bounce. Dormand-Prince divides it into many
    // stages.
    if (options.rollback.global && options.response == ResponseKind::rollback) {
        options.bounce_budget /= options.integrator.kind == IntegratorKind::dormand_prince ? 20 : 4;
    }
    options.bounce_budget = std::max<std::uint32_t>(1, options.bounce_budget);
    options.seed = choices.byte();
    options.max_depth = 2;
    options.most_particles = 24;
    if (choices.index(8) == 1) {
        options.flow = flow(choices);
        options.walls = choices.yes() ? WallRule::slide : WallRule::stop;
    }
    if (choices.index(8) == 1) setup.bounds = Box3{{-2, -2, -2}, {2, 2, 2}};
}

double radius(ByteChoices& choices) { return up_to(choices, {0.0, 0.25, 0.1, 1e-3}); }

Particle particle(ByteChoices& choices, double time_step) {
    Particle result;
    result.position = choices.point();
    // The fastest particles cross the scene in one step, so that they do not bounce endlessly when wedged between
    // surfaces.
    const double speed = choices.one_of<double>({0.0, 1.0, 10.0, std::min(1.0 / time_step, 100.0)});
    result.velocity = speed * choices.point();
    result.radius = radius(choices);
    result.mass = choices.one_of<double>({1.0, 0.01, 100.0});
    if (result.radius > 0.0 && choices.yes()) result.spin = 20.0 * choices.point();
    if (choices.index(8) == 1) result.lifetime = 0.1 * choices.part();
    result.pinned = choices.index(16) == 1;
    return result;
}

EmitterShape emitter_shape(ByteChoices& choices) {
    const Vec3 center = choices.point();
    switch (choices.index(6)) {
        case 0:
            return PointShape{center};
        case 1:
            return DiskShape{center, choices.direction(), 0.5};
        case 2:
            return BoxShape{center, {1, 0.5, 0}};
        case 3:
            return SphereShape{center, 0.5, choices.yes()};
        case 4:
            return ConeShape{center, choices.direction()};
        default:
            return MeshSurfaceShape{any_mesh(choices)};
    }
}

void add_emitters(ByteChoices& choices, SimulationSetup& setup) {
    EmitterDescription emitter;
    emitter.name = "source";
    emitter.shape = emitter_shape(choices);
    emitter.burst = choices.index(5);
    emitter.rate = {choices.part() / setup.options.time_step, 1.0};
    emitter.speed = {4.0 * choices.part(), 1.0};
    const double mean = radius(choices);
    emitter.radius = {mean, 0.5 * mean};
    emitter.cone_degrees = 180.0 * choices.part();
    if (choices.yes()) emitter.lifetime = {0.2 * choices.part(), 0.1};
    setup.emitters.push_back(std::move(emitter));
    if (!choices.yes()) return;
    EmitterDescription child;
    child.name = "child";
    child.rate = {10.0, 0.0};
    child.speed = {1.0, 0.5};
    ParentRule rule;
    rule.on = choices.one_of<BirthEvent>({BirthEvent::impact, BirthEvent::death, BirthEvent::life});
    rule.recursive = choices.yes();
    rule.count = {2.0, 1.0};
    rule.share = rule.on != BirthEvent::life && choices.yes();
    rule.threshold_impulse = choices.part();
    if (rule.on != BirthEvent::life) child.rate = {};
    child.parent = rule;
    setup.emitters.push_back(std::move(child));
}

void add_springs(ByteChoices& choices, SimulationSetup& setup) {
    const double step = setup.options.time_step;
    for (std::size_t k = 1; k < setup.particles.size(); ++k) {
        Spring spring;
        spring.first = k - 1;
        spring.second = k;
        spring.rest_length = choices.part();
        // The stiffness is low enough for explicit integrators. Otherwise particles would gain any speed and bounce
        // endlessly.
        const double lighter = std::min(setup.particles[k - 1].mass, setup.particles[k].mass);
        spring.stiffness = 0.5 * choices.part() * lighter / (step * step);
        spring.damping = 0.2 * choices.part() * lighter / step;
        setup.springs.push_back(spring);
    }
}

}  // namespace

SimulationSetup tiny_scene(ByteChoices choices) {
    SimulationSetup setup;
    add_options(choices, setup);
    if (setup.options.flow == nullptr) add_forces(choices, setup);
    const bool may_be_random = setup.options.response == ResponseKind::exact;
    for (int k = 0; k < 2; ++k) setup.materials.push_back(material(choices, may_be_random));
    const std::size_t colliders = 1 + choices.index(3);
    for (std::size_t k = 0; k < colliders; ++k) {
        const auto material = static_cast<std::uint32_t>(choices.index(2));
        setup.colliders.push_back({"collider " + std::to_string(k), collider_shape(choices), material});
    }
    const std::size_t particles = choices.index(5);
    for (std::size_t k = 0; k < particles; ++k) {
        setup.particles.push_back(particle(choices, setup.options.time_step));
    }
    if (choices.yes()) add_emitters(choices, setup);
    if (choices.index(4) == 1) add_springs(choices, setup);
    add_movers(choices, setup);
    return setup;
}

}  // namespace ricochet::fuzz
