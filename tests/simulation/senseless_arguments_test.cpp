// Invalid arguments are refused in one line that names the object and the value: no crash, no hang, no silence.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/collision_queries.h"
#include "ricochet/core/error.h"
#include "ricochet/simulation.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Returns a setup with one of everything, all of it valid.
SimulationSetup sensible() {
    SimulationSetup setup;
    setup.options.duration = 0.05;
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    setup.materials.push_back({"steel", 0.5, 0.1});
    setup.colliders.push_back({"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0});
    const auto mesh = std::make_shared<const TriangleMesh>(testing::box_mesh({-1, -1, -1}, {1, 1, 1}));
    setup.colliders.push_back({"mesh", MeshShape{mesh, {{5, 0, 2}}, ""}, 0});
    setup.colliders.push_back({"ball", BallShape{1.0, {{-5, 0, 2}}}, 0});
    setup.colliders.push_back({"can", CylinderShape{1.0, 2.0, {{0, 5, 2}}}, 0});
    setup.colliders.push_back({"box", CuboidShape{{1, 1, 1}, {{0, -5, 2}}}, 0});
    for (int k = 0; k < 3; ++k) {
        Particle particle;
        particle.position = {0.1 * k, 0, 1};
        particle.radius = 0.01;
        setup.particles.push_back(particle);
    }
    setup.springs.push_back({0, 1, 0.1, 5.0, 0.1});
    setup.spring_faces.push_back({{0, 1, 2}, {0, 0, 0}});
    EmitterDescription emitter;
    emitter.name = "source";
    emitter.shape = PointShape{{0, 0, 2}};
    emitter.rate = {100.0, 0.0};
    setup.emitters.push_back(emitter);
    setup.bounds = Box3{{-50, -50, -50}, {50, 50, 50}};
    return setup;
}

struct Refusal {
    std::string name;  ///< text that the message must contain
    std::function<void(SimulationSetup&)> spoil;
};

void expect_refused(const Refusal& refusal) {
    SCOPED_TRACE(refusal.name);
    SimulationSetup setup = sensible();
    refusal.spoil(setup);
    try {
        const Simulation simulation(std::move(setup));
        ADD_FAILURE() << "it was taken";
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find(refusal.name), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

/// Expects a refusal for each of the values of one number.
void expect_values_refused(const std::string& name, const std::vector<double>& values,
                           const std::function<void(SimulationSetup&, double)>& set) {
    for (const double value : values) {
        expect_refused({name, [&](SimulationSetup& setup) { set(setup, value); }});
    }
}

TEST(SenselessArguments, ValidSetupIsAccepted) {
    Simulation simulation(sensible());
    while (!simulation.finished()) simulation.step();
    EXPECT_GT(simulation.particles().size(), 3U);
}

TEST(SenselessArguments, OptionsAreRefused) {
    const std::vector<double> no_time{0.0, -1.0, kNan, kInfinity};
    expect_values_refused("time_step", no_time, [](auto& s, double x) { s.options.time_step = x; });
    expect_values_refused("frame_rate", no_time, [](auto& s, double x) { s.options.frame_rate = x; });
    expect_values_refused("duration", {-1.0, kNan, kInfinity, 1e300, 1e13},
                          [](auto& s, double x) { s.options.duration = x; });
    expect_values_refused("resting_speed", {-1.0, kNan, kInfinity},
                          [](auto& s, double x) { s.options.resting_speed = x; });
    expect_refused({"bounce_budget", [](auto& s) { s.options.bounce_budget = 0; }});
    expect_refused({"most_particles", [](auto& s) { s.options.most_particles = 1ULL << 40U; }});
    expect_refused({"most_particles", [](auto& s) { s.options.most_particles = 0; }});
    expect_refused({"walls", [](auto& s) { s.options.walls = static_cast<WallRule>(9); }});
    expect_refused({"tolerance", [](auto& s) { s.options.integrator.tolerance.position = 1e-300; }});
    expect_refused({"response", [](auto& s) { s.options.response = static_cast<ResponseKind>(99); }});
    expect_refused({"integrator", [](auto& s) { s.options.integrator.kind = static_cast<IntegratorKind>(99); }});
    expect_values_refused("tolerance.position", no_time,
                          [](auto& s, double x) { s.options.integrator.tolerance.position = x; });
    expect_values_refused("rollback.time_tolerance", no_time,
                          [](auto& s, double x) { s.options.rollback.time_tolerance = x; });
    expect_values_refused("project.offset", no_time, [](auto& s, double x) { s.options.project.offset = x; });
    expect_values_refused("penalty.stiffness", no_time, [](auto& s, double x) { s.options.penalty.stiffness = x; });
    expect_refused({"penalty.substeps", [](auto& s) { s.options.penalty.substeps = 0; }});
    expect_refused({"bounds", [](auto& s) { s.bounds = Box3{}; }});
    expect_refused({"bounds", [](auto& s) { s.bounds->lower.y = kNan; }});
}

TEST(SenselessArguments, MaterialsAreRefused) {
    const std::vector<double> no_part{-0.1, 1.5, 3.0, kNan, kInfinity};
    const std::vector<double> negative{-0.1, kNan, kInfinity};
    expect_values_refused("material \"steel\": restitution", no_part,
                          [](auto& s, double x) { s.materials[0].restitution = x; });
    expect_values_refused("diffuse", no_part, [](auto& s, double x) { s.materials[0].diffuse = x; });
    expect_values_refused("absorption", no_part, [](auto& s, double x) { s.materials[0].absorption = x; });
    expect_values_refused("friction", negative, [](auto& s, double x) { s.materials[0].friction = x; });
    expect_values_refused("rolling_friction", negative, [](auto& s, double x) { s.materials[0].rolling_friction = x; });
    expect_values_refused("restitution_threshold", negative,
                          [](auto& s, double x) { s.materials[0].restitution_threshold = x; });
    expect_values_refused("wall_temperature", {0.0, -3.0, kNan},
                          [](auto& s, double x) { s.materials[0].wall_temperature = x; });
    expect_refused({"material 0", [](auto& s) {
                        s.materials[0].name.clear();
                        s.materials[0].restitution = 3.0;
                    }});
}

TEST(SenselessArguments, CollidersAreRefused) {
    expect_refused({"collider \"ball\": material: found 7", [](auto& s) { s.colliders[2].material = 7; }});
    expect_refused({"found 1", [](auto& s) { s.colliders[0].material = 1; }});
    expect_refused({"collider \"floor\": name", [](auto& s) { s.colliders.push_back(s.colliders[0]); }});
    expect_refused({"material", [](auto& s) { s.materials.clear(); }});
    expect_refused({"null pointer", [](auto& s) { std::get<MeshShape>(s.colliders[1].shape).mesh = nullptr; }});
    expect_refused({"corner of a triangle: found 1000", [](auto& s) {
                        TriangleMesh mesh = testing::box_mesh({0, 0, 0}, {1, 1, 1});
                        mesh.triangles[3][2] = 1000;
                        std::get<MeshShape>(s.colliders[1].shape).mesh = std::make_shared<const TriangleMesh>(mesh);
                    }});
    expect_refused({"material of a triangle: found 5", [](auto& s) {
                        auto& shape = std::get<MeshShape>(s.colliders[1].shape);
                        shape.triangle_materials.assign(shape.mesh->triangles.size(), 0);
                        shape.triangle_materials.back() = 5;
                    }});
    expect_refused({"triangle_materials: found 2", [](auto& s) {
                        std::get<MeshShape>(s.colliders[1].shape).triangle_materials = {0, 0};
                    }});
    expect_refused({"vertex", [](auto& s) {
                        TriangleMesh mesh = testing::box_mesh({0, 0, 0}, {1, 1, 1});
                        mesh.vertices[0].x = kNan;
                        std::get<MeshShape>(s.colliders[1].shape).mesh = std::make_shared<const TriangleMesh>(mesh);
                    }});
    const std::vector<double> no_length{0.0, -1.0, kNan, kInfinity};
    expect_values_refused("radius", no_length,
                          [](auto& s, double x) { std::get<BallShape>(s.colliders[2].shape).radius = x; });
    expect_values_refused("radius", no_length,
                          [](auto& s, double x) { std::get<CylinderShape>(s.colliders[3].shape).radius = x; });
    expect_values_refused("height", no_length,
                          [](auto& s, double x) { std::get<CylinderShape>(s.colliders[3].shape).height = x; });
    expect_values_refused("size", no_length,
                          [](auto& s, double x) { std::get<CuboidShape>(s.colliders[4].shape).size.y = x; });
    expect_values_refused("\"floor\"", {kNan, kInfinity},
                          [](auto& s, double x) { std::get<PlaneShape>(s.colliders[0].shape).point.x = x; });
    expect_refused({"normal", [](auto& s) { std::get<PlaneShape>(s.colliders[0].shape).normal = {}; }});
    expect_values_refused("\"ball\"", {0.0, kNan},
                          [](auto& s, double x) { std::get<BallShape>(s.colliders[2].shape).placement.scale.x = x; });
    expect_values_refused("\"ball\": position", {kNan, 1e80}, [](auto& s, double x) {
        std::get<BallShape>(s.colliders[2].shape).placement.position.x = x;
    });
    expect_values_refused("rotation", {kNan, kInfinity}, [](auto& s, double x) {
        std::get<BallShape>(s.colliders[2].shape).placement.rotation_degrees = x;
    });
    expect_refused(
        {"rotation axis", [](auto& s) { std::get<BallShape>(s.colliders[2].shape).placement.rotation_axis = {}; }});
}

TEST(SenselessArguments, ParticlesAreRefused) {
    expect_values_refused("particle 1: mass", {0.0, 1e-322, -1.0, kNan, kInfinity},
                          [](auto& s, double x) { s.particles[1].mass = x; });
    expect_values_refused("particle 1: radius", {-1.0, kNan, kInfinity},
                          [](auto& s, double x) { s.particles[1].radius = x; });
    expect_values_refused("particle 2: position", {kNan, kInfinity, 1e80},
                          [](auto& s, double x) { s.particles[2].position.y = x; });
    expect_values_refused("velocity", {kNan, kInfinity, 1e300},
                          [](auto& s, double x) { s.particles[0].velocity.z = x; });
    expect_values_refused("spin", {kNan, kInfinity}, [](auto& s, double x) { s.particles[0].spin.z = x; });
    expect_values_refused("birth_time", {kNan, kInfinity}, [](auto& s, double x) { s.particles[0].birth_time = x; });
    expect_values_refused("lifetime", {kNan, -1.0}, [](auto& s, double x) { s.particles[0].lifetime = x; });
    expect_refused({"attributes: found 1", [](auto& s) { s.particles[0].attributes = {{1, 2, 3}}; }});
}

TEST(SenselessArguments, ForcesSpringsAndEmittersAreRefused) {
    expect_refused({"force 1: found a null pointer", [](auto& s) { s.forces.push_back(nullptr); }});
    expect_refused({"springs: number: found 1", [](auto& s) {
                        s.options.flow = make_wind({1, 0, 0});
                        s.options.integrator.kind = IntegratorKind::rk4;
                        s.forces.clear();
                    }});
    expect_refused({"spring 0: end: found 3", [](auto& s) { s.springs[0].second = 3; }});
    expect_refused({"both ends", [](auto& s) { s.springs[0].second = 0; }});
    expect_refused({"spring 0", [](auto& s) { s.springs[0].stiffness = kNan; }});
    expect_refused({"spring face 0: corner: found 9", [](auto& s) { s.spring_faces[0].corners[1] = 9; }});
    expect_refused({"spring face 0: edge: found 4", [](auto& s) { s.spring_faces[0].springs[2] = 4; }});
    expect_refused({"emitter \"source\": parent: found 4", [](auto& s) {
                        s.emitters[0].parent.emplace();
                        s.emitters[0].parent->emitter = 4;
                    }});
    expect_refused({"emitter \"source\": frame: found 2", [](auto& s) {
                        s.emitters[0].frames = std::make_shared<const FrameTree>();
                        s.emitters[0].frame = 2;
                    }});
    expect_values_refused("births", {1e200, 1e15}, [](auto& s, double x) { s.emitters[0].rate.mean = x; });
    expect_values_refused("source", {kNan, kInfinity}, [](auto& s, double x) { s.emitters[0].rate.mean = x; });
    expect_values_refused("source", {-1.0}, [](auto& s, double x) { s.emitters[0].rate.mean = x; });
    expect_values_refused("source", {1e-200, 1e200, kNan}, [](auto& s, double x) {
        s.emitters[0].direction = {x, 0, 0};
    });
    expect_values_refused("source", {1e80, kNan}, [](auto& s, double x) { s.emitters[0].speed.mean = x; });
    expect_values_refused("source", {1e200, 1e-200}, [](auto& s, double x) {
        s.emitters[0].shape = DiskShape{{}, {x, 0, 0}, 1.0};
    });
    expect_values_refused("source", {1e80}, [](auto& s, double x) { s.emitters[0].shape = SphereShape{{}, x}; });
    expect_refused({"burst", [](auto& s) { s.emitters[0].burst = 1ULL << 32U; }});
    expect_values_refused("source", {kNan, 1e-322, -1.0}, [](auto& s, double x) { s.emitters[0].mass.mean = x; });
    expect_values_refused("source", {kNan, -1.0}, [](auto& s, double x) { s.emitters[0].radius.mean = x; });
    expect_values_refused("center", {kNan, kInfinity}, [](auto& s, double x) {
        s.emitters[0].shape = PointShape{{x, 0, 0}};
    });
    expect_refused({"emitter \"source\": name", [](auto& s) { s.emitters.push_back(s.emitters[0]); }});
    expect_refused({"null pointer", [](auto& s) { s.emitters[0].shape = MeshSurfaceShape{}; }});
    expect_refused({"null pointer", [](auto& s) { s.emitters[0].shape = MeshVolumeShape{}; }});
    expect_refused(
        {"reference camera", [](auto& s) { s.reference_camera.emplace().target = s.reference_camera->position; }});
    expect_values_refused("field_of_view", {0.0, 180.0, kNan},
                          [](auto& s, double x) { s.reference_camera.emplace().field_of_view_degrees = x; });
}

/// A force of a user's own, with a name or without.
class OwnForce : public ParticlesForce {
public:
    explicit OwnForce(std::string name) : name_(std::move(name)) {}
    void add_accelerations(const ParticlesView&, std::span<Vec3>) const override {}
    [[nodiscard]] std::optional<double> potential_energy(const ParticlesView&) const override { return 0.0; }
    [[nodiscard]] std::string name() const override { return name_; }

private:
    std::string name_;
};

TEST(SenselessArguments, ForcesOnAllParticlesAreRefusedByTheirName) {
    const auto beside_implicit = [](const std::string& name) {
        return [name](SimulationSetup& s) {
            s.options.integrator = IntegratorKind::implicit_euler;
            s.particles_forces.push_back({std::make_shared<OwnForce>(name)});
        };
    };
    expect_refused({"whirl: integrator: found implicit_euler, expected an explicit one", beside_implicit("whirl")});
    expect_refused({"force between particles 0: integrator: found implicit_euler", beside_implicit("")});
    expect_refused({"force between particles 0: force", [](auto& s) { s.particles_forces.push_back({nullptr}); }});
}

TEST(SenselessArguments, FunctionsOfASimulationRefuseInvalidArguments) {
    Simulation simulation(sensible());
    simulation.step();
    const std::uint64_t hash = simulation.state_hash();
    Particle particle;
    particle.mass = -1.0;
    EXPECT_THROW((void)simulation.add_particle(particle), InputError);
    EXPECT_THROW((void)simulation.add_particles(std::vector<Particle>{Particle{}, particle}), InputError);
    std::vector<std::unique_ptr<Force>> forces;
    forces.push_back(nullptr);
    EXPECT_THROW(simulation.set_forces(std::move(forces)), InputError);
    EXPECT_FALSE(simulation.remove_particle(12345));
    EXPECT_EQ(simulation.remove_particles({}), 0U);
    EXPECT_TRUE(simulation.add_particles({}).empty());
    EXPECT_THROW((void)simulation.collider_mesh(99), InputError);
    EXPECT_THROW((void)simulation.triangle_totals(99), InputError);
    EXPECT_THROW((void)simulation.surface_name(1U << 30U), InputError);
    EXPECT_THROW((void)simulation.is_penetrating(1U << 30U), InputError);
    ContactRecord record;
    record.surface = 1U << 30U;
    EXPECT_THROW((void)simulation.contact_point(record), InputError);
    EXPECT_THROW(simulation.save({}), InputError);
    EXPECT_THROW(simulation.restore({}), InputError);
    EXPECT_EQ(simulation.state_hash(), hash);
    Simulation restored(sensible());
    EXPECT_THROW(
        restored.restore([](std::span<std::byte> bytes) { std::fill(bytes.begin(), bytes.end(), std::byte{7}); }),
        InputError);
    EXPECT_THROW(restored.step(), RunError);
    EXPECT_THROW((void)restored.add_particle(Particle{}), RunError);
}

TEST(SenselessArguments, PopulationIsLimitedToMostParticles) {
    SimulationSetup setup = sensible();
    setup.emitters.clear();
    setup.options.most_particles = 4;
    Simulation simulation(std::move(setup));
    (void)simulation.add_particle(Particle{});
    EXPECT_THROW((void)simulation.add_particle(Particle{}), InputError);
    EXPECT_TRUE(simulation.remove_particle(0));
    (void)simulation.add_particle(Particle{});
}

TEST(SenselessArguments, FailedStepCannotBeSaved) {
    SimulationSetup setup = sensible();
    setup.forces.push_back(make_force([](const ForceInput&) -> Vec3 { throw RunError("no force today"); }));
    Simulation simulation(std::move(setup));
    std::size_t bytes = 0;
    const ByteSink sink = [&](std::span<const std::byte> part) { bytes += part.size(); };
    simulation.save(sink);
    EXPECT_GT(bytes, 0U);
    bytes = 0;
    EXPECT_THROW(simulation.step(), RunError);
    EXPECT_THROW(simulation.save(sink), RunError);
    EXPECT_EQ(bytes, 0U);
}

// A burst of four thousand million particles, of which a thousand fit.
TEST(SenselessArguments, BirthsBeyondMostParticlesTakeNoMemory) {
    SimulationSetup setup = sensible();
    setup.options.most_particles = 1000;
    setup.emitters[0].burst = 0xFFFFFFFFU;
    setup.emitters[0].rate = {};
    Simulation simulation(std::move(setup));
    simulation.step();
    EXPECT_EQ(simulation.particles().size(), 1000U);
    EXPECT_EQ(simulation.statistics().births_refused_by_population, 0xFFFFFFFFU - 997U);
}

TEST(SenselessArguments, CollisionQueriesRefuseInvalidArguments) {
    EXPECT_THROW(CollisionQueries({{"ball", BallShape{-1.0, {}}, 0}}), InputError);
    EXPECT_THROW(CollisionQueries({{"ball", BallShape{1e160, {}}, 0}}), InputError);
    EXPECT_THROW(CollisionQueries({{"can", CylinderShape{1e160, 1.0, {}}, 0}}), InputError);
    EXPECT_THROW(CollisionQueries({{"mesh", MeshShape{}, 0}}), InputError);
    const CollisionQueries queries({{"ball", BallShape{1.0, {}}, 5}});
    for (const double bad : {kNan, kInfinity, -kInfinity, 1e80}) {
        EXPECT_THROW((void)queries.first_hit({bad, 0, 0}, {1, 0, 0}), InputError);
        EXPECT_THROW((void)queries.closest_point({0, bad, 0}), InputError);
        EXPECT_THROW((void)queries.is_inside({0, 0, bad}), InputError);
    }
    EXPECT_THROW((void)queries.first_hit({}, {0, 0, 0}), InputError);
    EXPECT_THROW((void)queries.first_hit({}, {kNan, 0, 0}), InputError);
    EXPECT_THROW((void)queries.first_hit({}, {kInfinity, 0, 0}), InputError);
    EXPECT_THROW((void)queries.first_hit({}, {1, 0, 0}, -1.0), InputError);
    EXPECT_THROW((void)queries.first_hit({}, {1, 0, 0}, kNan), InputError);
    EXPECT_THROW((void)queries.closest_point({}, -1.0), InputError);
    EXPECT_THROW((void)queries.closest_point({}, kNan), InputError);
    EXPECT_TRUE(queries.first_hit({}, {1e-300, 0, 0}).has_value());
    EXPECT_TRUE(queries.first_hit({}, {1e300, 1e300, 0}).has_value());
    EXPECT_TRUE(queries.first_hit({1e15, 0, 0}, {-1, 0, 0}).has_value());
}

std::string message_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    return "not refused";
}

TEST(SenselessArguments, MessageForAnEmptyListDoesNotAskForANegativeIndex) {
    SimulationSetup setup = sensible();
    setup.materials.clear();
    EXPECT_EQ(message_of([&] { const Simulation simulation(std::move(setup)); }),
              "collider \"floor\": material: found 0, expected none: there are no materials; add one first");
    const Simulation empty(SimulationSetup{});
    EXPECT_EQ(message_of([&] { (void)empty.collider_mesh(0); }), "collider: found 0, but there is none to choose from");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
