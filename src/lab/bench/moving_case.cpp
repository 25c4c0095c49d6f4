#include "lab/bench/moving_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "generators/build_near.h"
#include "generators/placement.h"
#include "generators/rock.h"
#include "ricochet/core/portable_math.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/mesh_motion.h"

namespace ricochet::bench {
namespace {

constexpr std::size_t kTrianglesOfARock = 1000;
constexpr double kLattice = 2.0;  // distance of adjacent rocks, in m
constexpr double kMovingCaseCoarseEdge = 0.25;
constexpr double kDegreesAStep = 1.0;
constexpr double kDegreesATumblingStep = 0.05;
constexpr double kBreath = 0.05;
constexpr int kKeysABreath = 10;
constexpr double kStepsAKey = 4.0;

TriangleMesh make_one_rock() {
    return meshes::build_near(kTrianglesOfARock, kMovingCaseCoarseEdge,
                              [](double edge) { return meshes::make_rock({.radius = 0.5}, edge); });
}

std::size_t count_of_rocks(std::size_t triangles) { return std::max<std::size_t>(1, triangles / kTrianglesOfARock); }

/// Returns the positions of `count` rocks. They fill a cubic lattice around the origin.
std::vector<Vec3> places_of_rocks(std::size_t count) {
    std::size_t side = 1;
    while (side * side * side < count) ++side;
    const double middle = 0.5 * static_cast<double>(side - 1);
    std::vector<Vec3> places;
    for (std::size_t k = 0; k < count; ++k) {
        const Vec3 cell{static_cast<double>(k % side), static_cast<double>(k / side % side),
                        static_cast<double>(k / side / side)};
        places.push_back(kLattice * (cell - Vec3{middle, middle, middle}));
    }
    return places;
}

FrameDescription frame_at(std::string name, const Vec3& placement, FrameMotion motion) {
    FrameDescription frame;
    frame.name = std::move(name);
    frame.translation = placement;
    frame.motions = {std::move(motion)};
    return frame;
}

Spin spin_of(const Case& c, std::size_t number) {
    RandomSequence random(1, 0, number);
    return {random.unit_vector(), kDegreesAStep / c.time_step};
}

std::string name_of_rock(std::size_t k) { return fmt::format("rock {}", k); }

MeshMotion breathing(const Case& c, const std::vector<Vec3>& vertices) {
    std::vector<double> times;
    std::vector<std::vector<Vec3>> positions;
    for (int k = 0; k <= kKeysABreath; ++k) {
        times.push_back(k * kStepsAKey * c.time_step);
        const double size = 1.0 + kBreath * sine_of_turns(static_cast<double>(k % kKeysABreath) / kKeysABreath);
        std::vector<Vec3>& all = positions.emplace_back();
        for (const Vec3& vertex : vertices) all.push_back(size * vertex);
    }
    return {std::move(times), std::move(positions), MeshEnds::repeat};
}

constexpr const char* kGroundFrame = "ground";
constexpr const char* kBystanderFrame = "bystander";

}  // namespace

TriangleMesh make_rocks(std::size_t triangles) {
    const TriangleMesh rock = make_one_rock();
    TriangleMesh mesh;
    for (const Vec3& placement : places_of_rocks(count_of_rocks(triangles))) {
        meshes::append(mesh, meshes::moved(rock, placement));
    }
    return mesh;
}

std::vector<ColliderDescription> colliders_of(const Case& c, const std::shared_ptr<const TriangleMesh>& mesh) {
    if (c.ground == Ground::rocks) {
        const auto rock = std::make_shared<const TriangleMesh>(make_one_rock());
        std::vector<ColliderDescription> colliders;
        for (const Vec3& placement : places_of_rocks(count_of_rocks(c.triangles))) {
            const std::string name = name_of_rock(colliders.size());
            const bool moves = c.moves == Moves::spinning;
            colliders.push_back({name, MeshShape{rock, {moves ? Vec3{} : placement}, ""}, 0, moves ? name : ""});
        }
        return colliders;
    }
    const bool moves = c.moves == Moves::shaken || c.moves == Moves::spinning || c.moves == Moves::tumbling;
    std::vector<ColliderDescription> colliders{{"ground", MeshShape{mesh, {}, ""}, 0, moves ? kGroundFrame : ""}};
    if (c.moves == Moves::breathing) {
        auto& shape = std::get<MeshShape>(colliders[0].shape);
        shape.motion = std::make_shared<const MeshMotion>(breathing(c, mesh->vertices));
    }
    if (c.moves == Moves::bystander) {
        const auto rock = std::make_shared<const TriangleMesh>(make_one_rock());
        colliders.push_back({"bystander", MeshShape{rock, {}, ""}, 0, kBystanderFrame});
    }
    return colliders;
}

std::shared_ptr<const FrameTree> frames_of(const Case& c) {
    std::vector<FrameDescription> frames;
    if (c.moves == Moves::nothing || c.moves == Moves::breathing) return nullptr;
    if (c.ground == Ground::rocks) {
        for (const Vec3& placement : places_of_rocks(count_of_rocks(c.triangles))) {
            const std::size_t k = frames.size();
            frames.push_back(frame_at(name_of_rock(k), placement, spin_of(c, k)));
        }
    } else if (c.moves == Moves::shaken) {
        frames.push_back(frame_at(kGroundFrame, {}, Oscillation{{0.05, 0.08, 0.03}, 0.2, 0.0}));
    } else if (c.moves == Moves::spinning) {
        frames.push_back(frame_at(kGroundFrame, {}, Spin{{1, 2, 3}, kDegreesAStep / c.time_step}));
    } else if (c.moves == Moves::tumbling) {
        frames.push_back(frame_at(kGroundFrame, {}, Spin{{1, 0, 0}, kDegreesATumblingStep / c.time_step}));
    } else {
        frames.push_back(frame_at(kBystanderFrame, {10, 0, 0}, spin_of(c, 0)));
    }
    return std::make_shared<const FrameTree>(std::move(frames));
}

std::vector<Flight> seen_from_ground(const Case& c, std::vector<Flight> flights, double time) {
    if (c.moves == Moves::breathing) {
        const double size = breathing(c, {{1, 0, 0}}).at(time).position(0).x;
        for (Flight& flight : flights) flight = {flight.position / size, flight.velocity / size};
        return flights;
    }
    const auto frames = frames_of(c);
    const auto frame = frames ? frames->find(kGroundFrame) : std::nullopt;
    if (!frame) return flights;
    const MovingPose pose = frames->at(*frame, time);
    for (Flight& flight : flights)
        flight = {pose.local_position(flight.position), pose.local_direction(flight.velocity)};
    return flights;
}

}  // namespace ricochet::bench
