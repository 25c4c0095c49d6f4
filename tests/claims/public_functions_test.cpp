// Calls every function of the public headers with invalid arguments. Each call is refused with a message of one line,
// or has a documented result. No call may crash, hang or ignore the error.
// tests/simulation/senseless_arguments_test.cpp tests the setup and the queries of a simulation.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/ricochet.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array kNotFinite{kNan, kInfinity, -kInfinity};
constexpr std::array kNoLength{0.0, -1.0, kNan, kInfinity};

/// Expects an error whose message is one line and not empty.
template <class Error = InputError>
void expect_refused(const char* what, const std::function<void()>& call) {
    SCOPED_TRACE(what);
    try {
        call();
        ADD_FAILURE() << "it was taken";
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_FALSE(message.empty());
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

template <class Values>
void expect_all_refused(const char* what, const Values& values, const std::function<void(double)>& call) {
    for (const double value : values) {
        SCOPED_TRACE(value);
        expect_refused(what, [&] { call(value); });
    }
}

TriangleMesh broken_mesh() { return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}}; }

AttributeDescription column(const std::string& name, int components = 1) { return {name, components, {}}; }

FrameTree one_frame(const std::string& name, const std::string& parent) {
    std::vector<FrameDescription> frames(1);
    frames[0].name = name;
    frames[0].parent = parent;
    return FrameTree(std::move(frames));
}

VerifiedShape flat_shape(double x) { return {{{x, 0, 0}, {0, 1, 0}, {0, 0, 1}, {}}}; }

Particles two_particles() {
    Particles particles;
    for (std::uint64_t id = 0; id < 2; ++id) {
        Particle particle;
        particle.id = id;
        particle.position = {static_cast<double>(id), 0, 0};
        particles.append(particle);
    }
    return particles;
}

TEST(PublicFunctions, RefuseInvalidArgumentsOfTheCore) {
    expect_refused("threads", [] { const ThreadLimit limit(-1); });
    const auto nothing = [](std::size_t, std::size_t, std::size_t) {};
    expect_refused("block size", [&] { parallel_for_blocks(5, 0, nothing); });
    expect_refused("empty function", [] { parallel_for_blocks(5, 1, {}); });
    expect_refused("block size", [] { (void)ordered_sum(5, 0, [](std::size_t, std::size_t) { return 1.0; }); });
    expect_refused("empty function", [] { (void)ordered_sum(5, 1, {}); });
    expect_all_refused("rotation", kNotFinite, [](double x) { (void)world_from_local({{}, {0, 0, 1}, x}); });
    expect_all_refused("position", kNotFinite, [](double x) { (void)world_from_local({{x, 0, 0}}); });
    expect_all_refused("scale", kNotFinite, [](double x) { (void)world_from_local({{}, {0, 0, 1}, 0.0, {1, x, 1}}); });
    expect_all_refused("axis", std::array{0.0, kNan, kInfinity}, [](double x) {
        (void)world_from_local({{}, {x, 0, 0}, 30.0});
    });
    FixedPointSum sum;
    for (const double bad : kNotFinite) EXPECT_FALSE(sum.add(bad, 1.0));
    EXPECT_FALSE(sum.add(1.0, 0.0));
    EXPECT_EQ(sum.value(1.0), 0.0);
    (void)morton_code({kNan, kInfinity, -kInfinity}, {{0, 0, 0}, {1, 1, 1}});
    (void)morton_code({0, 0, 0}, Box3{});
}

TEST(PublicFunctions, RefuseInvalidMeshes) {
    expect_refused("corner", [] { (void)bounds(broken_mesh()); });
    expect_refused("corner", [] { (void)surface_area(broken_mesh()); });
    expect_refused("corner", [] { (void)signed_volume(broken_mesh()); });
    expect_refused("corner", [] { require_corners(broken_mesh()); });
    EXPECT_TRUE(bounds(TriangleMesh{}).empty());
    EXPECT_EQ(surface_area(TriangleMesh{}), 0.0);
    EXPECT_EQ(signed_volume(TriangleMesh{}), 0.0);
    expect_refused("placement", [] { (void)transformed(broken_mesh(), {{kNan, 0, 0}}); });
    expect_all_refused("ball", kNoLength, [](double x) { (void)ball_mesh(x, {}); });
    expect_all_refused("cylinder", kNoLength, [](double x) { (void)cylinder_mesh(x, 1.0, {}); });
    expect_all_refused("cylinder", kNoLength, [](double x) { (void)cylinder_mesh(1.0, x, {}); });
    expect_all_refused("box", kNoLength, [](double x) { (void)cuboid_mesh({1, x, 1}); });
    expect_refused("no file", [] { (void)read_mesh("there/is/no.obj"); });
    expect_refused("a folder", [] { (void)read_mesh("/"); });
    expect_refused("nothing", [] { (void)read_mesh("a.obj", std::string_view()); });
    expect_refused("no format", [] { (void)read_mesh("a.txt", "v 1 2 3"); });
    EXPECT_FALSE(mesh_format_of("").has_value());
}

TEST(PublicFunctions, RefuseInvalidParticles) {
    expect_refused("name", [] { (void)AttributeTable({column("")}); });
    expect_refused("components", [] { (void)AttributeTable({column("a", 2)}); });
    expect_refused("twice", [] { (void)AttributeTable({column("a"), column("a")}); });
    expect_refused("own", [] { (void)AttributeTable({column("mass")}); });
    expect_all_refused("default", kNotFinite, [](double x) { (void)AttributeTable({{"a", 1, {x, 0, 0}}}); });
    AttributeTable table({column("a", 3)});
    table.append({});
    expect_refused("column", [&] { (void)table.value(1, 0); });
    expect_refused("entry", [&] { (void)table.value(0, 1); });
    expect_refused("column", [&] { table.set(1, 0, {}); });
    expect_refused("entry", [&] { table.set(0, 1, {}); });
    expect_refused("entry", [&] { (void)table.at(1); });
    expect_refused("length", [&] { table.compact({1, 1}); });
    EXPECT_FALSE(table.find("b").has_value());
    EXPECT_FALSE(looks_attribute("").has_value());
    Particles particles = two_particles();
    expect_refused("index", [&] { (void)particles.at(2); });
    expect_refused("length", [&] { particles.compact({1}); });
    EXPECT_EQ(particles.size(), 2U);
}

TEST(PublicFunctions, RefuseInvalidForces) {
    const ForceInput input{{0, 0, 0}, {1, 0, 0}, 1.0, 0.1, 0.0};
    expect_refused("null", [] {
        std::vector<std::unique_ptr<Force>> forces;
        forces.push_back(nullptr);
        const ForceField field(std::move(forces));
    });
    expect_refused("empty", [] { (void)make_force({}); });
    expect_refused("empty", [] { (void)make_acceleration({}); });
    expect_refused("null", [] { (void)make_force_on({1}, nullptr); });
    expect_refused("null", [] { (void)make_field_force(nullptr, FieldMeaning::force); });
    expect_refused("meaning", [] { (void)make_field_force(make_wind({}), static_cast<FieldMeaning>(9)); });
    for (const double bad : {-1.0, kNan, kInfinity}) {
        SCOPED_TRACE(bad);
        expect_refused("linear drag", [&] { (void)make_linear_drag(bad); });
        expect_refused("quadratic drag", [&] { (void)make_quadratic_drag(bad); });
        expect_refused("sphere drag", [&] { (void)make_sphere_drag(bad, 1.0); });
        expect_refused("sphere drag", [&] { (void)make_sphere_drag(1.0, bad); });
        expect_refused("Stokes", [&] { (void)make_stokes_drag(bad); });
        expect_refused("Schiller", [&] { (void)make_schiller_naumann_drag(bad, 1.0); });
        expect_refused("Schiller", [&] { (void)make_schiller_naumann_drag(1.0, bad); });
        expect_refused("buoyancy", [&] { (void)make_buoyancy(bad, {}); });
        expect_refused("softening", [&] { (void)make_point_gravity({{{}, 1.0, bad}}); });
        expect_refused("softening", [&] { (void)make_radial_force({{}, 1.0, -2.0, bad, 1.0}); });
        expect_refused("stiffness", [&] { (void)make_anchor({{}, bad}); });
        expect_refused("core", [&] { (void)make_swirl({}, {0, 0, 1}, 1.0, bad); });
    }
    for (const double bad : kNotFinite) {
        SCOPED_TRACE(bad);
        expect_refused("gravity", [&] { (void)make_gravity({bad, 0, 0}); });
        expect_refused("attractor", [&] { (void)make_point_gravity({{{bad, 0, 0}, 1.0}}); });
        expect_refused("attractor", [&] { (void)make_point_gravity({{{}, bad}}); });
        expect_refused("radial", [&] { (void)make_radial_force({{bad, 0, 0}, 1.0}); });
        expect_refused("radial", [&] { (void)make_radial_force({{}, bad}); });
        expect_refused("exponent", [&] { (void)make_radial_force({{}, 1.0, bad}); });
        expect_refused("charge", [&] { (void)make_lorentz_force({bad, {}, {}}); });
        expect_refused("field", [&] { (void)make_lorentz_force({1.0, {bad, 0, 0}, {}}); });
        expect_refused("swirl", [&] { (void)make_swirl({bad, 0, 0}, {0, 0, 1}, 1.0, 1.0); });
        expect_refused("swirl", [&] { (void)make_swirl({}, {bad, 0, 1}, 1.0, 1.0); });
        expect_refused("buoyancy", [&] { (void)make_buoyancy(1.0, {0, bad, 0}); });
    }
    expect_refused("axis", [] { (void)make_swirl({}, {}, 1.0, 1.0); });
    expect_refused("exponent", [] { (void)make_radial_force({{}, 1.0, 13.0}); });
    EXPECT_EQ(ForceField().acceleration(input), Vec3{});
    EXPECT_GT(schiller_naumann_coefficient(1.0), 24.0);
}

TEST(PublicFunctions, RefuseInvalidForcesBetweenParticles) {
    GravitySettings gravity;
    ChargeSettings charge;
    for (const double bad : kNotFinite) {
        SCOPED_TRACE(bad);
        gravity = {};
        gravity.constant = bad;
        expect_refused("constant", [&] { (void)make_mutual_gravity(gravity); });
        charge = {};
        charge.constant = bad;
        expect_refused("constant", [&] { (void)make_coulomb_force(charge); });
        expect_refused("stiffness", [&] { (void)make_cohesion({bad, 1.0, 0.0}); });
        expect_refused("damping", [&] { (void)make_cohesion({1.0, 1.0, bad}); });
    }
    for (const double bad : {-1.0, kNan, kInfinity, 1e80}) {
        SCOPED_TRACE(bad);
        gravity = {};
        gravity.softening = bad;
        expect_refused("softening", [&] { (void)make_mutual_gravity(gravity); });
    }
    for (const double bad : {0.0, -0.5, 1.5, kNan}) {
        SCOPED_TRACE(bad);
        charge = {};
        charge.opening = bad;
        expect_refused("opening", [&] { (void)make_coulomb_force(charge); });
    }
    charge = {};
    charge.attribute.clear();
    expect_refused("attribute", [&] { (void)make_coulomb_force(charge); });
    for (const double bad : kNoLength) {
        SCOPED_TRACE(bad);
        expect_refused("range", [&] { (void)make_cohesion({1.0, bad, 0.0}); });
        expect_refused("depth", [&] { (void)make_lennard_jones({bad, 1.0, 2.5}); });
        expect_refused("diameter", [&] { (void)make_lennard_jones({1.0, bad, 2.5}); });
        expect_refused("cutoff", [&] { (void)make_lennard_jones({1.0, 1.0, bad}); });
        PairLaw law;
        law.cutoff = bad;
        law.force = [](const PairState&) { return Vec3{}; };
        expect_refused("cutoff", [&] { (void)make_pair_force(law); });
    }
    expect_refused("function", [] { (void)make_pair_force({.cutoff = 1.0, .force = {}}); });
}

TEST(PublicFunctions, RefuseInvalidFlows) {
    expect_refused("empty", [] { (void)make_flow({}); });
    expect_refused("null", [] { (void)make_flow_sum({nullptr}); });
    expect_refused("null", [] { (void)make_scaled_flow(nullptr, 1.0); });
    for (const double bad : kNotFinite) {
        SCOPED_TRACE(bad);
        expect_refused("wind", [&] { (void)make_wind({bad, 0, 0}); });
        expect_refused("gusts", [&] { (void)make_gusty_wind({bad, 0, 0}, {}); });
        expect_refused("phase", [&] { (void)make_gusty_wind({}, {1.0, 1.0, bad}); });
        expect_refused("vortex", [&] { (void)make_vortex({{bad, 0, 0}}); });
        expect_refused("circulation", [&] { (void)make_vortex({{}, {0, 0, 1}, bad}); });
        expect_refused("source", [&] { (void)make_source({bad, 0, 0}, 1.0, 1.0); });
        expect_refused("source", [&] { (void)make_source({}, bad, 1.0); });
        expect_refused("rotation", [&] { (void)make_rotation({}, {0, bad, 0}); });
        expect_refused("shear", [&] { (void)make_shear({}, {bad, 0, 0}, {0, 0, 1}); });
        expect_refused("sphere", [&] { (void)make_flow_past_sphere({}, 1.0, {bad, 0, 0}); });
        expect_refused("scaled", [&] { (void)make_scaled_flow(make_wind({}), bad); });
        expect_refused("grid", [&] { (void)make_grid_flow({{}, {1, 1, 1}, {1, 1, 1}, {{bad, 0, 0}}}); });
    }
    expect_all_refused("core", kNoLength, [](double x) { (void)make_source({}, 1.0, x); });
    expect_all_refused("core", kNoLength, [](double x) { (void)make_vortex({{}, {0, 0, 1}, 1.0, x}); });
    expect_all_refused("radius", kNoLength, [](double x) { (void)make_flow_past_sphere({}, x, {}); });
    expect_all_refused("spacing", kNoLength, [](double x) {
        (void)make_grid_flow({{}, {1, x, 1}, {1, 1, 1}, {Vec3{}}});
    });
    expect_refused("axis", [] { (void)make_vortex({{}, {}, 1.0, 1.0}); });
    expect_refused("profile", [] { (void)make_vortex({{}, {0, 0, 1}, 1.0, 1.0, static_cast<VortexProfile>(8)}); });
    expect_refused("gradient", [] { (void)make_shear({}, {1, 0, 0}, {}); });
    expect_refused("counts", [] { (void)make_grid_flow({{}, {1, 1, 1}, {0xFFFFFFFFU, 0xFFFFFFFFU, 2}, {Vec3{}}}); });
    expect_refused("outside", [] {
        (void)make_grid_flow({{}, {1, 1, 1}, {1, 1, 1}, {Vec3{}}}, static_cast<OutsideGrid>(7));
    });
    const FlowPointer grid = make_grid_flow({{}, {1, 1, 1}, {2, 1, 1}, {Vec3{}, Vec3{1, 0, 0}}});
    for (const double bad : kNotFinite) EXPECT_TRUE(is_finite(grid->velocity({bad, bad, bad}, 0.0)));
    for (const double bad : {-1.0, kNan, kInfinity}) {
        TurbulenceSettings settings;
        settings.speed = bad;
        expect_refused("turbulence", [&] { (void)make_turbulence(settings); });
        settings = {};
        settings.length = bad;
        expect_refused("turbulence", [&] { (void)make_turbulence(settings); });
        settings = {};
        settings.gain = bad;
        expect_refused("turbulence", [&] { (void)make_turbulence(settings); });
        settings = {};
        settings.rate = bad;
        expect_refused("turbulence", [&] { (void)make_turbulence(settings); });
    }
    TurbulenceSettings settings;
    for (const std::uint32_t octaves : {0U, kMostOctaves + 1}) {
        settings.octaves = octaves;
        expect_refused("octaves", [&] { (void)make_turbulence(settings); });
    }
    const FlowPointer eddies = make_turbulence({});
    for (const double bad : kNotFinite) (void)eddies->velocity({bad, 0, 1e300}, bad);
}

TEST(PublicFunctions, RefuseInvalidFramesAndCurves) {
    expect_all_refused("constant", kNotFinite, [](double x) { (void)KeyedCurve<double>(x); });
    expect_all_refused("key", kNotFinite, [](double x) { (void)KeyedCurve<double>({{x, 1.0}}); });
    expect_refused("no keys", [] { (void)KeyedCurve<Vec3>(std::vector<CurveKey<Vec3>>{}); });
    expect_refused("order", [] { (void)KeyedCurve<double>({{1.0, 0.0}, {0.0, 0.0}}); });
    expect_refused("interpolation", [] { (void)KeyedCurve<double>({{0.0, 0.0}}, static_cast<Interpolation>(9)); });
    expect_refused("ends", [] {
        (void)KeyedCurve<double>({{0.0, 0.0}, {1.0, 0.0}}, Interpolation::linear, static_cast<CurveEnds>(9));
    });
    EXPECT_TRUE(name_of(static_cast<Interpolation>(9)).empty());
    const KeyedCurve<double> curve({{0.0, 0.0}, {1.0, 2.0}}, Interpolation::spline, CurveEnds::repeat);
    for (const double bad : kNotFinite) {
        (void)curve.value(bad);
        (void)curve.derivative(bad);
    }
    expect_refused("name", [] { (void)one_frame("", ""); });
    expect_refused("parent", [] { (void)one_frame("a", "b"); });
    expect_refused("circle", [] { (void)one_frame("a", "a"); });
    const FrameTree frames = one_frame("a", "");
    expect_refused("frame", [&] { (void)frames.at(1, 0.0); });
    expect_refused("frame", [&] { (void)frames.description(1); });
    expect_refused("frame", [&] { (void)launched_from(frames, 1, {}); });
    EXPECT_FALSE(frames.find("b").has_value());
}

TEST(PublicFunctions, RefuseInvalidSprings) {
    expect_refused("itself", [] { (void)SpringNetwork({{0, 0, 1.0, 1.0}}); });
    expect_all_refused("length", std::array{-1.0, kNan, kInfinity}, [](double x) {
        (void)SpringNetwork({{0, 1, x, 1.0}});
    });
    SpringNetwork network({{0, 1, 1.0, 1.0}});
    expect_refused("links", [&] { (void)network.links(0); });
    expect_refused("twice", [&] { network.bind(std::array<std::uint64_t, 2>{1, 1}); });
    expect_refused("twice", [&] { network.bind(std::array<std::uint64_t, 3>{1, 0, 1}); });
    network.bind(std::array<std::uint64_t, 2>{0, 1});
    const std::vector<Vec3> one(1);
    expect_refused("links", [&] { (void)network.links(2); });
    expect_refused("spring", [&] { (void)network.is_intact(1); });
    expect_refused("length", [&] { (void)network.potential_energy(one); });
    expect_refused("length", [&] { (void)network.break_overstretched(one); });
    expect_refused("length", [&] { (void)network.force_on(0, one, one); });
    EXPECT_EQ(spring_force({0, 1, 1.0, 1.0}, {}, {}, {}, {}), Vec3{});
    expect_refused("rope", [] { (void)make_rope({}); });
    expect_refused("cloth", [] { (void)make_cloth(TriangleMesh{}, {}); });
    expect_refused("corner", [] { (void)make_cloth(broken_mesh(), {}); });
    for (const double bad : kNotFinite) {
        expect_refused("sheet", [&] { (void)sheet_mesh({bad, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1); });
        expect_refused("sheet", [&] { (void)sheet_mesh({}, {bad, 0, 0}, {0, 1, 0}, 1, 1); });
    }
    expect_refused("cells", [] { (void)sheet_mesh({}, {1, 0, 0}, {0, 1, 0}, 0, 1); });
    expect_refused("cells", [] { (void)sheet_mesh({}, {1, 0, 0}, {0, 1, 0}, 1ULL << 40U, 1ULL << 40U); });
    const std::vector<Spring> springs{{0, 1, 1.0, 1.0}};
    expect_refused("end", [&] { (void)longest_stable_step(IntegratorKind::rk4, springs, {Particle{}}); });
    expect_refused(
        "kind", [&] { (void)longest_stable_step(static_cast<IntegratorKind>(99), springs, std::vector<Particle>(2)); });
    EXPECT_TRUE(name_of(static_cast<IntegratorKind>(99)).empty());
    EXPECT_TRUE(name_of(static_cast<ResponseKind>(99)).empty());
    EXPECT_FALSE(response_from_name("").has_value());
}

TEST(PublicFunctions, RefuseInvalidParticleSystems) {
    const Particles particles = two_particles();
    SpringNetwork springs({{0, 1, 1.0, 1.0}});
    springs.bind(particles.id);
    const ForceField forces;
    ParticleSystem system(forces, springs);
    expect_refused("member", [&] { system.assign(particles, std::array<std::uint32_t, 1>{2}, 0.0); });
    expect_refused("order", [&] { system.assign(particles, std::array<std::uint32_t, 2>{1, 0}, 0.0); });
    expect_refused("twice", [&] { system.assign(particles, std::array<std::uint32_t, 2>{1, 1}, 0.0); });
    system.assign(particles, std::array<std::uint32_t, 2>{0, 1}, 0.0);
    std::vector<double> short_state(11);
    std::vector<double> state(12);
    std::vector<Vec3> one(1);
    std::vector<Vec3> two(2);
    expect_refused("state", [&] { system.get_state(short_state); });
    expect_refused("state", [&] { system.set_state(short_state); });
    expect_refused("state", [&] { system.derivative(0.0, short_state); });
    expect_refused("state", [&] { system.derivative(0.0, short_state, state); });
    expect_refused("state", [&] { system.derivative(0.0, state, short_state); });
    expect_refused("phase", [&] { system.set_phase(one, two); });
    expect_refused("phase", [&] { system.set_phase(two, one); });
    expect_refused("accelerations", [&] { system.accelerations(0.0, two, two, one); });
    expect_refused("accelerations", [&] { system.accelerations(0.0, one, two, two); });
    expect_refused("energy", [&] { (void)system.spring_energy(one); });
    expect_refused("force", [&] { (void)system.spring_force_on(2, two, two); });
    expect_refused("force", [&] { (void)system.spring_force_on(0, one, two); });
    expect_refused("input", [&] { (void)system.input(2, 0.0, {}, {}); });
    expect_refused("own", [&] { (void)system.own_acceleration(2, 0.0, {}, {}); });
    expect_refused("slope", [&] { (void)system.own_slope(2, {}, 1.0); });
    expect_refused("mass", [&] { (void)system.mass(2); });
    expect_refused("id", [&] { (void)system.id(2); });
    expect_refused("pinned", [&] { (void)system.is_pinned(2); });
    expect_refused("spring", [&] { (void)system.spring_of({7, 0, 1}); });
}

TEST(PublicFunctions, RefuseInvalidEmitterShapes) {
    const auto broken = std::make_shared<const TriangleMesh>(broken_mesh());
    std::vector<EmitterShape> shapes{MeshSurfaceShape{},      MeshVolumeShape{}, MeshSurfaceShape{broken},
                                     MeshVolumeShape{broken}, DiskShape{{}, {}}, ConeShape{{}, {}},
                                     BoxShape{{}, {-1, 1, 1}}};
    for (const double bad : kNotFinite) {
        shapes.emplace_back(PointShape{{bad, 0, 0}});
        shapes.emplace_back(DiskShape{{0, bad, 0}});
        shapes.emplace_back(BoxShape{{0, bad, 0}});
        shapes.emplace_back(SphereShape{{0, bad, 0}});
        shapes.emplace_back(ConeShape{{0, bad, 0}});
    }
    for (const double bad : kNoLength) {
        shapes.emplace_back(SphereShape{{}, bad});
        shapes.emplace_back(DiskShape{{}, {0, 0, 1}, bad});
        shapes.emplace_back(ConeShape{{}, {0, 0, 1}, 20.0, bad});
    }
    for (std::size_t k = 0; k < shapes.size(); ++k) {
        SCOPED_TRACE(k);
        expect_refused("sampler", [&] { (void)ShapeSampler(shapes[k]); });
        expect_refused("bounds", [&] { (void)bounds(shapes[k]); });
        expect_refused("outline", [&] { (void)outline_points(shapes[k], {0, 0, 9}, 8); });
        expect_refused("area", [&] { (void)screen_area(shapes[k], {{0, 0, 9}}); });
    }
    expect_refused("segments", [] { (void)outline_points(SphereShape{}, {0, 0, 9}, -1); });
    expect_refused("eye", [] { (void)outline_points(SphereShape{}, {0, kNan, 9}, 8); });
    const ReferenceCamera camera{{0, 0, 9}};
    for (const double bad : {kNan, 0.0, 200.0}) {
        ReferenceCamera other = camera;
        other.field_of_view_degrees = bad;
        expect_refused("view", [&] { (void)screen_area(SphereShape{}, other); });
    }
    for (const double bad : kNoLength) {
        ReferenceCamera other = camera;
        other.image_height = bad;
        expect_refused("height", [&] { (void)screen_area(SphereShape{}, other); });
    }
    expect_refused("target", [&] { (void)screen_area(SphereShape{}, {{0, 0, 9}, {0, 0, 9}}); });
    expect_refused("inside", [&] { (void)screen_area(SphereShape{}, {{0, 0, 0.5}, {0, 0, 1}}); });
}

TEST(PublicFunctions, RefuseInvalidEmitters) {
    const auto expect_emitter_refused = [](const char* what, const std::function<void(EmitterDescription&)>& spoil) {
        EmitterDescription description;
        spoil(description);
        expect_refused(what, [&] { (void)Emitter(description, 0, 0); });
    };
    expect_emitter_refused("frame", [](auto& e) { e.frame = 1; });
    expect_emitter_refused("event", [](auto& e) { e.parent.emplace().on = static_cast<BirthEvent>(77); });
    expect_emitter_refused("attribute", [](auto& e) { e.attributes = {{"a", {}, {}}}; });
    expect_emitter_refused("rates", [](auto& e) {
        e.rate.mean = 1.0;
        e.rate_per_frame.mean = 1.0;
    });
    expect_emitter_refused("camera", [](auto& e) { e.rate_per_area.mean = 1.0; });
    const std::vector<AttributeDescription> columns{column("a")};
    EmitterDescription description;
    description.attributes = {{"a", {}, {}}, {"a", {}, {}}};
    expect_refused("twice", [&] { (void)Emitter(description, 0, 0, {24.0, {}, columns}); });
    description.attributes.clear();
    expect_all_refused("frame rate", kNoLength, [&](double x) { (void)Emitter(description, 0, 0, {x, {}, {}}); });
    expect_refused("number", [&] { (void)Emitter(description, 0, 0xFFFFFFFFU); });
    description.rate.mean = 1.0;
    Emitter emitter(description, 0, 0);
    expect_all_refused("times", kNotFinite, [&](double x) { (void)emitter.births(0.0, x); });
    expect_all_refused("times", kNotFinite, [&](double x) { (void)emitter.births(x, 1.0); });
    EXPECT_TRUE(emitter.births(1.0, 0.0).empty());
    EXPECT_FALSE(emitter.sets(99));
    EXPECT_FALSE(emitter.column("b").has_value());
    EXPECT_EQ(shown_value({}, "a", {1, 2, 3}, kNan, kNan), (Vec3{1, 2, 3}));
}

TEST(PublicFunctions, RefuseInvalidArgumentsOfTheVerifier) {
    expect_refused("corner", [] { (void)Verifier({broken_mesh()}); });
    TriangleMesh box = testing::box_mesh({0, 0, 0}, {1, 1, 1});
    for (const double bad : kNotFinite) {
        TriangleMesh mesh = box;
        mesh.vertices[2].y = bad;
        expect_refused("vertex", [&] { (void)Verifier({mesh}); });
        expect_refused("plane", [&] { (void)Verifier({VerifiedPlane{{bad, 0, 0}, {0, 0, 1}}}); });
        expect_refused("shape", [&] { (void)Verifier({flat_shape(bad)}); });
    }
    expect_refused("normal", [] { (void)Verifier({VerifiedPlane{{}, {}}}); });
    expect_refused("volume", [] { (void)Verifier({flat_shape(0.0)}); });
    const Verifier one({box});
    const Verifier two({box, VerifiedPlane{{}, {0, 0, 1}}});
    VerifiedParticle particle = two.watch({5, 5, 5}, 0.1);
    std::vector<Violation> violations;
    const VerifiedStep step{0, {5, 5, 5}, {6, 5, 5}, 0.1, 0.0, {}};
    expect_refused("another's", [&] { one.check(step, particle, violations); });
    for (const double bad : kNotFinite) {
        particle = two.watch({5, 5, 5}, bad);
        particle = two.watch({bad, 5, 5}, 0.1);
        const std::array segments{Segment{{5, 5, 5}, {bad, 5, 5}}};
        two.check({0, {5, 5, 5}, {bad, 5, 5}, bad, bad, segments}, particle, violations);
    }
    EXPECT_FALSE(violations.empty());
}

TEST(PublicFunctions, RefuseInvalidVtkFrames) {
    const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "senseless.vtp";
    Particles particles = two_particles();
    const AttributeTable attributes({column("a")});
    expect_refused("attributes", [&] { (void)particle_frame(particles, attributes, 0.0); });
    VtkPolyData frame = particle_frame(particles, 0.0);
    SpringNetwork springs({{0, 5, 1.0, 1.0}});
    springs.bind(std::array<std::uint64_t, 6>{0, 1, 2, 3, 4, 5});
    expect_refused("springs", [&] { add_springs(frame, particles, springs, {}); });
    SpringNetwork fitting({{0, 1, 1.0, 1.0}});
    fitting.bind(particles.id);
    expect_refused("face", [&] { add_springs(frame, particles, fitting, {{{0, 1, 1}, {0, 0, 7}}}); });
    expect_refused("corner", [&] { add_springs(frame, particles, fitting, {{{0, 1, 9}, {0, 0, 0}}}); });
    VtkPolyData other;
    expect_refused("other frame", [&] { add_springs(other, particles, fitting, {}); });
    expect_refused("mesh", [] { (void)mesh_collider_frame(broken_mesh(), {}, 0.0); });
    const TriangleMesh box = testing::box_mesh({0, 0, 0}, {1, 1, 1});
    expect_refused("totals", [&] { (void)mesh_collider_frame(box, {{1, 2}, {{}, {}}}, 0.0); });
    expect_refused("totals", [&] { (void)mesh_collider_frame(box, {{1}, {}}, 0.0); });
    expect_refused("plane", [] { (void)plane_collider_frame({{}, {}}, {}, {}, 0.0); });
    expect_refused("plane", [] { (void)plane_collider_frame({{kNan, 0, 0}}, {}, {}, 0.0); });
    frame = particle_frame(particles, 0.0);
    frame.point_arrays.push_back({"short", std::vector<double>(1)});
    expect_refused("array", [&] { (void)write_vtp(file, frame); });
    expect_all_refused("time", kNotFinite, [&](double x) { (void)write_vtp(file, particle_frame(particles, x)); });
    frame = particle_frame(particles, 0.0);
    frame.lines.push_back({0, 2});
    expect_refused("line", [&] { (void)write_vtp(file, frame); });
    expect_refused("a folder", [&] { (void)write_vtp(::testing::TempDir(), particle_frame(particles, 0.0)); });
    expect_refused<RunError>("no folder", [&] { (void)write_vtp(file / "x.vtp", particle_frame(particles, 0.0)); });
    EXPECT_FALSE(std::filesystem::exists(file));
    expect_all_refused("time", kNotFinite, [](double x) { (void)pvd_text({{x, 0, "a"}}); });
    EXPECT_EQ(find_array({}, ""), nullptr);
    EXPECT_EQ(find_field(other, ""), nullptr);
    EXPECT_TRUE(scalar_values({}).empty());
}

TEST(PublicFunctions, RefuseInvalidScenes) {
    expect_refused("no file", [] { (void)read_scene("there/is/no.json"); });
    expect_refused("nothing", [] { (void)parse_scene("", "a.json"); });
    expect_refused("no object", [] { (void)parse_scene("[]", "a.json"); });
    expect_refused("change", [] { (void)parse_scene("{}", "a.json", {"="}); });
    EXPECT_EQ(uniform_acceleration(SimulationSetup{}), Vec3{});
    SimulationSetup setup;
    setup.forces.push_back(nullptr);
    expect_refused("null", [&] { (void)uniform_acceleration(setup); });
}

TEST(PublicFunctions, RefuseCallsOnAMovedFromSimulation) {
    Simulation from{SimulationSetup{}};
    Simulation to(std::move(from));
    // NOLINTBEGIN(bugprone-use-after-move,hicpp-invalid-access-moved): the test uses moved objects on purpose
    expect_refused<RunError>("step", [&] { from.step(); });
    expect_refused<RunError>("advance", [&] { from.advance(1); });
    expect_refused<RunError>("finished", [&] { (void)from.finished(); });
    expect_refused<RunError>("particles", [&] { (void)from.particles(); });
    expect_refused<RunError>("hash", [&] { (void)from.state_hash(); });
    expect_refused<RunError>("save", [&] { from.save([](std::span<const std::byte>) {}); });
    expect_refused<RunError>("add", [&] { (void)from.add_particle({}); });
    from = std::move(to);
    EXPECT_FALSE(from.finished());
    // NOLINTEND(bugprone-use-after-move,hicpp-invalid-access-moved)
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
