#include "lab/bench/case_run.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "generators/build_near.h"
#include "generators/primitives.h"
#include "generators/rock.h"
#include "generators/terrain.h"
#include "generators/vessels.h"
#include "lab/bench/moving_case.h"
#include "lab/bench/timing.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/portable_math.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet::bench {

StarShapedInterior::StarShapedInterior(const TriangleMesh& mesh, const Vec3& kernel_point)
    : mesh_(mesh), kernel_point_(kernel_point), bvh_(mesh.vertices, mesh.triangles, 0.0) {}

bool StarShapedInterior::contains(const Vec3& p) const {
    bool is_seen = true;
    bvh_.query_segment(kernel_point_, p, [&](std::uint32_t triangle) {
        const Triangle& t = mesh_.triangles[triangle];
        const auto& v = mesh_.vertices;
        if (!segment_intersects_triangle(kernel_point_, p, v[t[0]], v[t[1]], v[t[2]])) return 1.0;
        is_seen = false;
        return 0.0;
    });
    return is_seen;
}

bool StarShapedInterior::contains_ball(const Vec3& middle, double radius) const {
    if (!contains(middle)) return false;
    if (radius == 0.0) return true;
    bool is_clear = true;
    bvh_.query_point(middle, radius, [&](std::uint32_t triangle) {
        const Triangle& t = mesh_.triangles[triangle];
        const auto& v = mesh_.vertices;
        const auto nearest = closest_point_on_triangle(middle, v[t[0]], v[t[1]], v[t[2]]);
        if (nearest.distance_squared >= radius * radius) return radius;
        is_clear = false;
        return 0.0;
    });
    return is_clear;
}

namespace {

constexpr std::uint64_t kSeed = 1;

// Edge lengths at which build_near() starts, in m. The terrain is larger than the other grounds and needs a coarser
// start.
constexpr double kCoarseEdge = 0.25;
constexpr double kCoarseTerrainEdge = 15.0;

TriangleMesh make_rough_bowl(double edge) {
    TriangleMesh mesh = meshes::make_cavity({}, edge);
    std::erase_if(mesh.triangles, [&](const Triangle& t) {
        return mesh.vertices[t[0]].z + mesh.vertices[t[1]].z + mesh.vertices[t[2]].z > 0.0;
    });
    return mesh;
}

// Creates a bin that is open at the top. Its floor is in the plane z = 0.
TriangleMesh make_bin(double edge) {
    constexpr double kWalls = 0.8;
    TriangleMesh mesh = meshes::make_box({.length = 0.2, .width = 0.2, .height = kWalls}, edge);
    for (Vec3& vertex : mesh.vertices) vertex.z += 0.5 * kWalls;
    std::erase_if(mesh.triangles, [&](const Triangle& t) {
        return mesh.vertices[t[0]].z == kWalls && mesh.vertices[t[1]].z == kWalls && mesh.vertices[t[2]].z == kWalls;
    });
    return mesh;
}

TriangleMesh make_ground(Ground ground, double edge) {
    switch (ground) {
        case Ground::cavity:
            return meshes::make_cavity({}, edge);
        case Ground::bowl:
            return meshes::make_bowl({}, edge);
        case Ground::rough_bowl:
            return make_rough_bowl(edge);
        case Ground::terrain:
            return meshes::make_terrain({}, edge);
        case Ground::wedge:
            return meshes::make_wedge({.length = 1.0, .opening = 0.01, .width = 1.0}, edge);
        case Ground::bin:
            return make_bin(edge);
        case Ground::rocks:
            break;  // make_rocks() creates the rocks
    }
    throw InputError("a benchmark case names a ground that does not exist");
}

// Particles per unit of parallel work.
constexpr std::size_t kBlock = 4096;

// Radii use a separate stream of random numbers. Points and spheres therefore start at the same positions, except where
// a sphere would overlap the ground.
constexpr std::uint32_t kPlaceStream = 0;
constexpr std::uint32_t kRadiusStream = 1;

double mass_of(const Case& c, double radius) {
    constexpr double kUnitSphere = 4.18879020478639098;  // in m^3
    return c.density * kUnitSphere * radius * radius * radius;
}

double radius_of(const Case& c, std::uint64_t index) {
    if (c.least_radius == c.largest_radius) return c.least_radius;
    RandomSequence random(kSeed, kRadiusStream, index);
    return c.least_radius * portable_pow(c.largest_radius / c.least_radius, random.uniform());
}

// Returns the lattice positions of a case. In a closed ground, the distance to the ground must be at least half the
// pitch. A sphere then does not overlap the ground, whatever its random offset.
std::vector<Vec3> lattice_places(const Case& c, const StarShapedInterior* interior) {
    std::vector<Vec3> places;
    const Vec3 size = c.box.size();
    const auto count = [&](int axis) { return static_cast<std::size_t>(size[axis] / c.pitch) + 1; };
    for (std::size_t k = 0; places.size() < c.particles && k < count(0) * count(1) * count(2); ++k) {
        const Vec3 step{static_cast<double>(k % count(0)), static_cast<double>(k / count(0) % count(1)),
                        static_cast<double>(k / count(0) / count(1))};
        const Vec3 placement = c.box.lower + c.pitch * step;
        if (interior == nullptr || interior->contains_ball(placement, 0.5 * c.pitch)) places.push_back(placement);
    }
    if (places.size() < c.particles) throw InputError("a benchmark case has more particles than lattice positions");
    return places;
}

Vec3 place_in(const Case& c, RandomSequence& random) {
    const Vec3 size = c.box.size();
    Vec3 position = c.box.lower;
    for (int axis = 0; axis < 3; ++axis) position[axis] += random.uniform() * size[axis];
    if (c.start == Start::above_terrain) position.z += meshes::terrain_height({}, position.x, position.y);
    return position;
}

}  // namespace

std::optional<Vec3> kernel_point_of(Ground ground) {
    if (ground == Ground::cavity) return Vec3{};
    if (ground == Ground::wedge) return Vec3{0.5, 0.0, 0.0};
    return std::nullopt;
}

std::shared_ptr<const TriangleMesh> make_mesh(const Case& c) {
    if (c.ground == Ground::rocks) return std::make_shared<const TriangleMesh>(make_rocks(c.triangles));
    const double edge = c.ground == Ground::terrain ? kCoarseTerrainEdge : kCoarseEdge;
    return std::make_shared<const TriangleMesh>(
        meshes::build_near(c.triangles, edge, [&](double length) { return make_ground(c.ground, length); }));
}

std::vector<Particle> make_particles(const Case& c, const TriangleMesh& mesh) {
    std::optional<StarShapedInterior> interior;
    const std::optional<Vec3> kernel_point = kernel_point_of(c.ground);
    if (c.start == Start::inside || (c.start == Start::lattice && kernel_point))
        interior.emplace(mesh, kernel_point.value());
    std::vector<Vec3> lattice;
    if (c.start == Start::lattice) lattice = lattice_places(c, interior ? &*interior : nullptr);
    const double beside = 0.49 * c.pitch - c.largest_radius;
    std::vector<Particle> particles(c.particles);
    parallel_for_blocks(particles.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Particle& particle = particles[i];
            particle.radius = radius_of(c, i);
            RandomSequence random(kSeed, kPlaceStream, i);
            particle.position = lattice.empty() ? place_in(c, random) : lattice[i] + beside * random.unit_vector();
            if (c.density > 0.0) particle.mass = mass_of(c, particle.radius);
            while (lattice.empty() && interior && !interior->contains_ball(particle.position, particle.radius)) {
                particle.position = place_in(c, random);
            }
            const double speed = random.uniform_around(c.speed, c.spread);
            particle.velocity = c.drift + speed * random.unit_vector();
        }
    });
    return particles;
}

SimulationSetup make_setup(const Case& c, const std::shared_ptr<const TriangleMesh>& mesh) {
    SimulationSetup setup;
    setup.options.time_step = c.time_step;
    setup.options.duration = static_cast<double>(c.warm_up + c.steps) * c.time_step;
    setup.options.seed = kSeed;
    setup.options.response = c.response;
    if (c.gravity != 0.0) setup.forces.push_back(make_gravity({0.0, 0.0, -c.gravity}));
    setup.materials.push_back({.name = "ground", .restitution = c.restitution, .friction = c.friction});
    if (c.spheres_meet) {
        setup.options.particle_contacts = PairContactSettings{.restitution = c.restitution, .friction = c.friction};
    }
    setup.acceleration.look_ahead = c.looks_ahead;
    setup.colliders = colliders_of(c, mesh);
    setup.frames = frames_of(c);
    return setup;
}

namespace {

double held_by_simulation(SimulationSetup setup, const std::vector<Particle>& particles) {
    const auto before = static_cast<double>(allocated_bytes());
    setup.particles = particles;
    Simulation simulation(std::move(setup));
    simulation.step();
    return static_cast<double>(allocated_bytes()) - before;
}

}  // namespace

std::uint64_t allocated_bytes() {
    const auto info = ::mallinfo2();
    return info.uordblks + info.hblkhd;
}

void return_freed_memory() { (void)::malloc_trim(0); }

MemoryUse measure_memory(const Case& c, const std::shared_ptr<const TriangleMesh>& mesh,
                         const std::vector<Particle>& particles) {
    const auto held = [&](const std::vector<Particle>& who) { return held_by_simulation(make_setup(c, mesh), who); };
    (void)held({});  // excludes one-time allocations of the first simulation in a process
    const double mesh_bytes =
        static_cast<double>(sizeof(Vec3) * mesh->vertices.capacity() + sizeof(Triangle) * mesh->triangles.capacity());
    MemoryUse use;
    // The bytes are counted instead of measured, because Embree maps large blocks without the allocator.
    std::vector<ColliderDescription> colliders = colliders_of(c, mesh);
    for (ColliderDescription& collider : colliders) {
        collider.frame.clear();
        if (auto* shape = std::get_if<MeshShape>(&collider.shape)) shape->motion = nullptr;
    }
    const CollisionWorld world(std::move(colliders));
    use.bytes_per_triangle =
        (mesh_bytes + static_cast<double>(world.memory_bytes())) / static_cast<double>(mesh->triangles.size());
    use.bytes_per_particle = std::max(0.0, held(particles) - held({})) / static_cast<double>(particles.size());
    return use;
}

namespace {

std::vector<Flight> flights_of(const Particles& particles) {
    std::vector<Flight> flights;
    flights.reserve(particles.size());
    for (const std::uint32_t i : particles.order_by_id()) {
        flights.push_back({particles.position[i], particles.velocity[i]});
    }
    return flights;
}

/// Returns true if the references trace the flights of the state before this step. Such steps are evenly spaced.
bool is_snapshot(std::uint64_t step, const Case& c) {
    const std::uint64_t snapshots = std::clamp<std::uint64_t>(kReferenceFlights / c.particles, 1, c.steps);
    return step == 0 || step * snapshots / c.steps != (step - 1) * snapshots / c.steps;
}

}  // namespace

CaseRun::CaseRun(const Case& c, std::shared_ptr<const TriangleMesh> mesh)
    : case_(c), mesh_(std::move(mesh)), particles_(make_particles(c, *mesh_)) {}

Simulation CaseRun::make_simulation() const {
    SimulationSetup setup = make_setup(case_, mesh_);
    setup.particles = particles_;
    return Simulation(std::move(setup));
}

bool CaseRun::run_once(const Announce& announce, std::vector<std::vector<Flight>>& states) {
    Simulation simulation = make_simulation();
    const auto keep = [&](std::span<const std::byte> bytes) {
        start_.insert(start_.end(), bytes.begin(), bytes.end());
    };
    if (case_.warm_up == 0) simulation.save(keep);
    for (std::uint64_t step = 1; step <= case_.warm_up; ++step) {
        if (!announce("warm-up", step)) return false;
        if (step == case_.warm_up) simulation.save(keep);
        simulation.step();
    }
    const SimulationStatistics before = simulation.statistics();
    if (case_.moves != Moves::nothing) naive_start_ = flights_of(simulation.particles());
    for (std::uint64_t step = 0; step < case_.steps; ++step) {
        if (!announce("first run", step + 1)) return false;
        if (is_snapshot(step, case_)) {
            states.push_back(seen_from_ground(case_, flights_of(simulation.particles()), simulation.time()));
        }
        simulation.step();
    }
    results_.particle_steps = simulation.statistics().particle_steps - before.particle_steps;
    results_.contacts = simulation.statistics().contacts - before.contacts;
    results_.pair_impacts = simulation.statistics().pair_impacts - before.pair_impacts;
    results_.largest_overlap = simulation.statistics().overlap_largest;
    results_.state_hash = simulation.state_hash();
    return true;
}

bool CaseRun::prepare(const Announce& announce) {
    if (!announce("memory", 0)) return false;
    memory_ = measure_memory(case_, mesh_, particles_);
    std::vector<std::vector<Flight>> states;
    if (!run_once(announce, states)) return false;
    if (!announce("references", 0)) return false;
    reference_.emplace(*mesh_, states, NativeRays::BounceRules{case_.time_step, case_.restitution});
    // Leaks are counted only for the response `exact`. Other responses let particles enter the wall, and flights of the
    // references would start inside the wall.
    const std::optional<Vec3> kernel_point = kernel_point_of(case_.ground);
    if (kernel_point && case_.response == ResponseKind::exact) reference_->count_leaks(*mesh_, *kernel_point);
    if (case_.moves == Moves::nothing) return true;
    if (!announce("naive motion", 0)) return false;
    naive_.emplace(colliders_of(case_, mesh_), frames_of(case_));
    std::vector<Flight> flights = naive_start_;
    (void)naive_->run(flights, naive_steps());
    if (kernel_point)
        naive_leaks_ = count_outside(seen_from_ground(case_, std::move(flights), end_of_steps()), *kernel_point);
    return true;
}

NaiveMotion::Steps CaseRun::naive_steps() const {
    return {static_cast<double>(case_.warm_up) * case_.time_step, case_.time_step, case_.steps, case_.restitution};
}

double CaseRun::end_of_steps() const { return static_cast<double>(case_.warm_up + case_.steps) * case_.time_step; }

std::uint64_t CaseRun::count_outside(const std::vector<Flight>& flights, const Vec3& kernel_point) const {
    const StarShapedInterior interior(*mesh_, kernel_point);
    return static_cast<std::uint64_t>(std::count_if(
        flights.begin(), flights.end(), [&](const Flight& flight) { return !interior.contains(flight.position); }));
}

bool CaseRun::time_simulation(CaseTimes& times, const Announce& announce) {
    Simulation simulation = make_simulation();
    std::size_t offset = 0;
    simulation.restore([&](std::span<std::byte> bytes) {
        if (bytes.size() > start_.size() - offset) throw RunError("the benchmark's saved state is too short");
        std::memcpy(bytes.data(), start_.data() + offset, bytes.size());
        offset += bytes.size();
    });
    if (!announce("simulation", 1)) return false;
    // This step is not timed, because the first step of a restored simulation queries every particle.
    if (case_.warm_up > 0) simulation.step();
    bool goes_on = true;
    const double seconds = time_of([&] {
        simulation.advance(case_.steps, [&] {
            goes_on = announce("simulation", simulation.step_index() - case_.warm_up);
            return goes_on;
        });
    });
    if (!goes_on) return false;
    if (simulation.state_hash() != results_.state_hash) {
        throw RunError(
            fmt::format("{} of suite {}: a repeat with {} threads has ended in another state than the first run",
                        case_.name, case_.suite, thread_count()));
    }
    times.simulation.push_back(seconds);
    return true;
}

bool CaseRun::time(CaseTimes& times, const Announce& announce) {
    if (!announce("collision structures", 0) || !time_simulation(times, announce)) return false;
    if (!announce("raw rays", 0)) return false;
    times.raw.push_back(time_of([&] { reference_->trace(); }));
    if (!announce("raw rays in spatial order", 0)) return false;
    times.sorted.push_back(time_of([&] { reference_->trace_sorted(); }));
    if (!announce("native bounces", 0)) return false;
    times.bounces.push_back(time_of([&] { reference_->bounce(); }));
    if (!naive_) return true;
    if (!announce("naive motion", 0)) return false;
    std::vector<Flight> flights = naive_start_;
    times.naive.push_back(time_of([&] { (void)naive_->run(flights, naive_steps()); }));
    return true;
}

}  // namespace ricochet::bench
