/// \file
/// Emitters: where, when and how particles are born. The schedule of births depends on the emitter alone, never on the
/// time step; each birth has its own random numbers, keyed by the particle's number within the emitter.
/// Method: W. T. Reeves, "Particle Systems: A Technique for Modeling a Class of Fuzzy Objects", ACM TOG 2(2), 1983
/// (mean and spread for every attribute).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/frame_tree.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/geometry/triangle_mesh.h"

namespace ricochet {

/// Mean and spread: values are uniform in [mean - spread, mean + spread).
struct MeanSpread {
    double mean = 0.0;
    double spread = 0.0;  ///< >= 0
};

/// All births at one point.
struct PointShape {
    Vec3 center;
};
/// Uniform on a flat disk.
struct DiskShape {
    Vec3 center;
    Vec3 normal{0, 0, 1};  ///< not zero
    double radius = 1.0;   ///< m, > 0
};
/// Uniform in an axis-aligned box.
struct BoxShape {
    Vec3 center;
    Vec3 size{1, 1, 1};  ///< full edge lengths, m, >= 0
};
/// Uniform in a ball, or on its surface.
struct SphereShape {
    Vec3 center;
    double radius = 1.0;   ///< m, > 0
    bool surface = false;  ///< true: births on the sphere itself, launched along the outward normal
};
/// Uniform by area on a triangle mesh, launched along the triangle normals.
struct MeshSurfaceShape {
    std::shared_ptr<const TriangleMesh> mesh;  ///< in world coordinates (placement already applied)
};
using EmitterShape = std::variant<PointShape, DiskShape, BoxShape, SphereShape, MeshSurfaceShape>;

/// One emitter, as a scene describes it.
struct EmitterDescription {
    std::string name;
    EmitterShape shape;
    std::uint64_t burst = 0;  ///< particles born at once at `start`
    MeanSpread rate;          ///< particles per second from `start` to `stop`; redrawn for every second
    double start = 0.0;       ///< s
    double stop = std::numeric_limits<double>::infinity();  ///< s, end of the rate
    /// Launch direction; zero means the shape's own (disk normal, sphere or mesh normal; for point, box and ball a
    /// uniform random direction).
    Vec3 direction;
    double cone_degrees = 0.0;  ///< half angle of the cone about the direction, uniform in solid angle, 0..180
    MeanSpread speed;           ///< m/s
    Vec3 velocity;              ///< m/s, added to direction * speed
    MeanSpread mass{1.0, 0.0};  ///< kg, mean - spread > 0
    MeanSpread radius;          ///< m, mean - spread >= 0; 0 is a point
    MeanSpread lifetime{std::numeric_limits<double>::infinity(), 0.0};  ///< s
    std::uint64_t limit = std::numeric_limits<std::uint64_t>::max();    ///< most particles ever born here
    /// Null pointer: shape, direction and velocity are in world coordinates. Otherwise they are in those of the frame
    /// of that number at the time of birth, and particles are let go from it, see launched_from().
    std::shared_ptr<const FrameTree> frames = nullptr;
    std::size_t frame = 0;
};

/// The births of one emitter in time order.
class Emitter {
public:
    /// seed: the scene's seed; stream: this emitter's number in the scene, below 2^24.
    /// Throws InputError when the description is outside the ranges stated there, naming the member.
    Emitter(EmitterDescription description, std::uint64_t seed, std::uint32_t stream);

    /// Particles born in [from, to), in birth order, with birth_time, position, velocity, mass and lifetime set and id
    /// left 0. Calls must go on where the last one ended, the first one begins at 0. How the time is cut into calls
    /// changes no bit. The burst is born at `start`; after that birth k happens when the integral of the rate since
    /// `start` passes k + 1/2. The rate is drawn anew for every whole second since `start` (negative draws count as 0).
    [[nodiscard]] std::vector<Particle> births(double from, double to);

    [[nodiscard]] const EmitterDescription& description() const { return description_; }

private:
    struct Launch {
        Vec3 position;
        Vec3 direction;  ///< the shape's own, of unit length
    };
    [[nodiscard]] Particle make_particle(std::uint64_t number, double time) const;
    [[nodiscard]] Launch launch_from(double radius, RandomSequence& random) const;
    [[nodiscard]] Launch launch_from_mesh(const TriangleMesh& mesh, double radius, RandomSequence& random) const;
    [[nodiscard]] Vec3 in_cone(const Vec3& axis, RandomSequence& random) const;
    [[nodiscard]] double rate_in_second(std::uint64_t second) const;
    void append_births(std::uint64_t count, double time, std::vector<Particle>& births);
    void append_steady_births(double to, std::vector<Particle>& births);
    void append_redrawn_births(double to, std::vector<Particle>& births);

    EmitterDescription description_;
    std::uint64_t seed_;
    std::uint32_t stream_;
    std::vector<double> cumulative_area_;  ///< of a mesh shape's triangles
    double cone_height_ = 0.0;             ///< 1 - cos(cone angle)
    std::uint64_t born_ = 0;
    bool burst_done_ = false;
    std::uint64_t second_ = 0;  ///< whole seconds since start that are accounted for in expected_
    double expected_ = 0.0;     ///< integral of the rate up to second_
    std::uint64_t rate_born_ = 0;
};

}  // namespace ricochet
