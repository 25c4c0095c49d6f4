/// \file
/// Emitters: positions, times and initial states of births. The schedule of births depends only on the emitter, not on
/// the time step. The random numbers of each birth depend on its number within the emitter. Method: W. T. Reeves,
/// "Particle Systems: A Technique for Modeling a Class of Fuzzy Objects", ACM TOG 2(2), 1983.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/keyed_curve.h"
#include "ricochet/core/random.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/birth_schedule.h"
#include "ricochet/dynamics/distribution.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

// Births of particles from other particles.

/// Event at which a particle gives birth.
enum class BirthEvent {
    life,    ///< at a constant rate during its whole life
    death,   ///< at the end of its lifetime, or when a surface absorbs it
    impact,  ///< at an impact whose impulse reaches the threshold
    birth,   ///< at its own birth
};

/// Fate of the children of a cloud when their parent ends.
enum class CloudEnd {
    free,  ///< the children then fly independently
    die,   ///< the children end with the parent
};

/// Children that move with their parent through flights and bounces. The target position of each child relative to the
/// parent is drawn from the emitter's shape. A child receives its parent's acceleration and the parent's velocity
/// changes at impacts. Forces act on it only through its parent. Surfaces act on it directly, and it keeps the
/// resulting motion relative to the parent.
struct CloudRule {
    Vec3 turning;          ///< angular velocity, in rad/s, of the target positions about the parent
    double pull = 0.0;     ///< acceleration towards the target divided by the distance from the target, in 1/s^2, >= 0
    double damping = 0.0;  ///< deceleration divided by the velocity relative to the target, in 1/s, >= 0
    CloudEnd end = CloudEnd::free;
};

/// Rule for an emitter whose particles are born from other particles.
struct ParentRule {
    std::uint32_t emitter = 0;  ///< scene number of the emitter whose particles are the parents
    bool recursive = false;     ///< true: the children become parents too
    BirthEvent on = BirthEvent::life;
    /// Number of children per death, impact or birth; draws are rounded, negative draws count as 0.
    DrawnValue count{1.0, 0.0};
    double threshold_impulse = 0.0;  ///< least impulse, in N s, of an impact that gives birth; >= 0
    /// True if the parent ends and the children share its mass and momentum. EmitterDescription::mass is then the
    /// weight of a share, and radii follow from the parent's density. Not available for BirthEvent::life.
    bool share = false;
    double inherit_velocity = 1.0;  ///< fraction of the parent's velocity that a child inherits; 1 when sharing
    double inherit_color = 0.0;     ///< fraction, 0..1, of the parent's colour in the child's colour
    /// Rule of a cloud, whose children inherit all of their parent's velocity; nothing if they fly independently. Not
    /// available for BirthEvent::death or sharing.
    std::optional<CloudRule> cloud = std::nullopt;
};

// Factors of attributes over a particle's life. The products are computed when a state is shown and are never stored,
// so they do not depend on the time step.

/// Factor of one attribute over a particle's life.
struct LifeCurve {
    std::string name;         ///< name of the attribute
    KeyedCurve<Vec3> factor;  ///< factor for each component; a scalar attribute uses x
    /// True if the curve's time is the elapsed fraction of the lifetime, 0..1; false if it is the age, in s.
    bool of_lifetime = true;
};

/// Returns a value multiplied by the factors of all curves for `name` at an age, in s. The elapsed fraction of an
/// infinite lifetime is 0.
[[nodiscard]] AttributeValue shown_value(std::span<const LifeCurve> curves, std::string_view name,
                                         const AttributeValue& value, double age, double lifetime);

// Shapes of birth positions: points, surfaces and volumes. Births are distributed uniformly.

/// All births at one point.
struct PointShape {
    Vec3 center;
};
/// Births distributed uniformly on a flat disk.
struct DiskShape {
    Vec3 center;
    Vec3 normal{0, 0, 1};  ///< not zero
    double radius = 1.0;   ///< in m, > 0
};
/// Births distributed uniformly in an axis-aligned box.
struct BoxShape {
    Vec3 center;
    Vec3 size{1, 1, 1};  ///< full edge lengths, in m, >= 0
};
/// Births distributed uniformly in a ball, or on its surface.
struct SphereShape {
    Vec3 center;
    double radius = 1.0;   ///< in m, > 0
    bool surface = false;  ///< true: births on the surface, launched along the outward normal
};
/// Births distributed uniformly by area on a triangle mesh, launched along the triangle normals.
struct MeshSurfaceShape {
    std::shared_ptr<const TriangleMesh> mesh;  ///< in world coordinates (transform already applied)
};
/// Births distributed uniformly in a cone, launched along the line from the apex.
struct ConeShape {
    Vec3 apex;
    Vec3 axis{0, 0, 1};           ///< direction from the apex into the cone, not zero
    double angle_degrees = 20.0;  ///< angle between the axis and the side, from 0 (a line) to less than 90
    double height = 1.0;          ///< in m, > 0
};
/// Births distributed uniformly inside a closed mesh. The inside test is exact (MeshInterior).
struct MeshVolumeShape {
    std::shared_ptr<const TriangleMesh> mesh;  ///< in world coordinates
};
using EmitterShape =
    std::variant<PointShape, DiskShape, BoxShape, SphereShape, MeshSurfaceShape, ConeShape, MeshVolumeShape>;

/// Birth position with its launch direction.
struct LaunchPoint {
    Vec3 position;
    Vec3 direction;  ///< launch direction of the shape at this position, of unit length
};

class MeshInterior;

/// Draws positions in a shape.
class ShapeSampler {
public:
    /// Throws InputError if the shape is outside the stated ranges, for a mesh surface without area, and for a mesh
    /// volume that is not closed or fills less than kSmallestFill of its box.
    explicit ShapeSampler(const EmitterShape& shape);

    /// Draws a birth position. radius: distance of the particle's centre from a mesh surface, in m.
    [[nodiscard]] LaunchPoint draw(double radius, RandomSequence& random) const;

    /// Smallest fraction of its box that a mesh volume must fill. Below it, rejection sampling would take too long.
    /// Local: a limit of input values.
    static constexpr double kSmallestFill = 1e-4;

private:
    [[nodiscard]] LaunchPoint on_disk(const DiskShape& disk, RandomSequence& random) const;
    [[nodiscard]] LaunchPoint in_cone(const ConeShape& cone, RandomSequence& random) const;
    [[nodiscard]] LaunchPoint on_mesh(const TriangleMesh& mesh, double radius, RandomSequence& random) const;
    [[nodiscard]] LaunchPoint in_mesh(RandomSequence& random) const;

    EmitterShape shape_;
    std::vector<double> cumulative_area_;         // running sums of the triangle areas of a mesh surface
    std::shared_ptr<const MeshInterior> inside_;  // inside test of a mesh volume
    double cone_slope_ = 0.0;                     // tangent of a cone's angle
};

/// Returns points that have the same convex hull as the shape. Each circle is replaced by `segments` points on it, at
/// least 3, and a ball by its outline as seen from `seen_from`. This function and the two functions below throw
/// InputError for values out of range, like ShapeSampler.
[[nodiscard]] std::vector<Vec3> outline_points(const EmitterShape& shape, const Vec3& seen_from, int segments);
/// Returns a bounding box of the shape.
[[nodiscard]] Box3 bounds(const EmitterShape& shape);

// Size of an emitter on the screen of a reference camera, for births in proportion to the screen area (W. T. Reeves,
// section 2.1, second rule). Distant emitters then cost little. The camera does not depend on rendering.

/// Pinhole camera with square pixels.
struct ReferenceCamera {
    Vec3 position;                        ///< in m
    Vec3 target{0, 0, -1};                ///< in m, different from position
    double field_of_view_degrees = 35.0;  ///< from the lower to the upper edge, 1..170
    double image_height = 720.0;          ///< pixels from the lower to the upper edge, > 0
};

/// Returns the area, in pixels, of the convex hull of the projected shape, including parts outside the image. The image
/// plane is at the distance image_height / (2 tan(field_of_view / 2)), in pixels. Round shapes are approximated by
/// polygons with 256 corners. Throws InputError if a part of the shape is not in front of the camera, or if the camera
/// is outside its stated ranges.
[[nodiscard]] double screen_area(const EmitterShape& shape, const ReferenceCamera& camera);

// Particles launched from a moving frame.

/// Converts position, velocity and spin of a particle at its birth from a frame to world coordinates. The velocity of
/// the frame at the particle is added. A sphere turns with the frame until its birth, so the frame's angular velocity
/// is added to its spin. Throws InputError unless frame < frames.size().
[[nodiscard]] Particle launched_from(const FrameTree& frames, std::size_t frame, Particle particle);

// The emitter itself.

/// Distribution of launch directions in a cone about the direction.
enum class DirectionLaw {
    uniform,  ///< uniform in solid angle
    cosine,   ///< in proportion to the cosine of the angle (Lambert's law), for cones of at most 90 degrees
};

/// Law of thermal velocities.
enum class ThermalLaw {
    volume,    ///< velocities of the molecules in a volume: each component is normal (Maxwell)
    effusion,  ///< velocities of the molecules that leave through an opening, in proportion to their normal speed
};

/// Launch velocities of gas molecules.
struct ThermalLaunch {
    ThermalLaw law = ThermalLaw::volume;
    double temperature = 0.0;    ///< in K, > 0
    double molecule_mass = 0.0;  ///< in kg, > 0; independent of EmitterDescription::mass
    /// For effusion: mean speed of the gas along the direction, in m/s, at most 1000 thermal speeds.
    double drift = 0.0;
};

/// Returns the fault of values outside the stated ranges; empty for sound values.
[[nodiscard]] std::string thermal_problem(const ThermalLaunch& thermal);
/// Returns the standard deviation of each component of the thermal velocities, in m/s.
[[nodiscard]] double thermal_speed(const ThermalLaunch& thermal);

/// Mean and spread of an attribute, for each component.
struct AttributeSpread {
    std::string name;  ///< name of one of the scene's attributes, including the columns of appearance
    Vec3 mean;         ///< mean; a scalar attribute uses x
    Vec3 spread;       ///< spread, each component >= 0
};

/// One emitter, as described by a scene.
struct EmitterDescription {
    std::string name;
    EmitterShape shape;
    std::uint64_t burst = 0;  ///< particles born together at `start`
    MeanSpread rate;          ///< particles per second from `start` to `stop`, drawn anew for every second
    /// Alternative rate: particles per second as a function of the simulation time. It is linear between the points,
    /// and constant before the first and after the last one. Ascending times.
    std::vector<RatePoint> rate_curve;
    /// Alternative rate: particles per frame (EmitterSurroundings::frame_rate), drawn anew for every frame.
    MeanSpread rate_per_frame;
    /// Alternative rate: particles per frame and per pixel of the shape's screen_area().
    MeanSpread rate_per_area;
    double start = 0.0;                                     ///< in s
    double stop = std::numeric_limits<double>::infinity();  ///< end of the births by a rate, in s
    /// Launch direction. Zero selects the shape's own direction: the disk, sphere or mesh normal, or a uniform random
    /// direction for point, box and ball.
    Vec3 direction;
    /// Half angle, 0..180, of the cone about the direction; launches are uniform in solid angle.
    double cone_degrees = 0.0;
    DirectionLaw direction_law = DirectionLaw::uniform;
    DrawnValue speed;                                                   ///< in m/s
    Vec3 velocity;                                                      ///< in m/s, added to direction * speed
    DrawnValue mass{1.0, 0.0};                                          ///< in kg, > 0
    DrawnValue radius;                                                  ///< in m, >= 0; 0 is a point
    DrawnValue lifetime{std::numeric_limits<double>::infinity(), 0.0};  ///< in s
    std::uint64_t limit = std::numeric_limits<std::uint64_t>::max();    ///< largest total number of births
    /// Frames of the scene, or null: shape, direction and velocity are then in world coordinates. Otherwise they are in
    /// the coordinates of frame number `frame` at the time of birth, see launched_from().
    std::shared_ptr<const FrameTree> frames = nullptr;
    std::size_t frame = 0;
    std::vector<AttributeSpread> attributes;  ///< colours and opacities are clamped to 0..1, sizes to >= 0
    std::vector<LifeCurve> curves;  ///< factors of attributes over a particle's life, applied when a state is shown
    /// Own seed; if empty, the random numbers depend on the scene's seed and the emitter's index.
    std::optional<std::uint64_t> seed;
    /// Rule for births from other particles. Burst, start and stop are then unused, and only clouds use the shape.
    std::optional<ParentRule> parent;
    BirthSpacing spacing = BirthSpacing::regular;  ///< spacing of the births of a rate
    /// Density, in kg/m^3, from which the mass follows instead of `mass`. Radii must then be above 0.
    std::optional<double> density = std::nullopt;
    /// Thermal velocities instead of cone and speed. For effusion, `direction` or the shape gives the direction.
    std::optional<ThermalLaunch> thermal = std::nullopt;
};

/// Returns the mass of a sphere, in kg. density: in kg/m^3. radius: in m.
[[nodiscard]] double sphere_mass(double density, double radius);
/// Return bounds of the masses that the emitter draws, in kg.
[[nodiscard]] double least_mass(const EmitterDescription& emitter);
[[nodiscard]] double most_mass(const EmitterDescription& emitter);
/// Returns the expected mass, in kg, for a density the mass of the sphere of the expected radius.
[[nodiscard]] double expected_mass(const EmitterDescription& emitter);
/// Returns an upper bound of the launch speed along the direction, in m/s, without `velocity`. Thermal speeds are
/// larger with a probability below 1e-7.
[[nodiscard]] double most_speed(const EmitterDescription& emitter);

/// Returns true if the emitter's particles move with their parents.
[[nodiscard]] inline bool is_cloud(const EmitterDescription& emitter) {
    return emitter.parent && emitter.parent->cloud.has_value();
}

/// Scene data that an emitter depends on.
struct EmitterSurroundings {
    double frame_rate = 24.0;  ///< frames per second for rates per frame, > 0; does not depend on output or time step
    std::optional<ReferenceCamera> camera = std::nullopt;   ///< for rates per screen area
    std::span<const AttributeDescription> attributes = {};  ///< columns of the particles
};

/// Test that returns true if a particle, in world coordinates, may be born at its position. The test must be pure.
using BirthTest = std::function<bool(const Particle&)>;

class Launch;

/// Births of one emitter in time order.
class Emitter {
public:
    /// Largest number of new positions that are tried if the test rejects a birth. With fewer tries, births are skipped
    /// in narrow spaces that have a free position. With more tries, spaces without one cost more time. Local, because
    /// public headers cannot include the tolerances.
    static constexpr int kMostRedraws = 64;

    /// seed: the scene's seed. number: this emitter's number in the scene, below 2^24 - 1. Throws an InputError that
    /// names the member if the description is outside its stated ranges.
    Emitter(EmitterDescription description, std::uint64_t seed, std::uint32_t number,
            const EmitterSurroundings& surroundings = {});

    /// Returns the particles born in [from, to), in birth order, with the id 0. An emitter with a parent rule returns
    /// none. The first call must start at 0, and each later call at the end of the call before. The results have the
    /// same bits for any division of time into calls. Throws InputError for non-finite times.
    ///
    /// The burst is born at `start`. Birth k after the burst happens when the integral of the rate since `start`
    /// reaches k + 1/2. The rate is drawn anew for every whole second (or frame). Negative draws count as 0.
    ///
    /// most: largest number of particles that are made and returned. born() also counts the births beyond it.
    ///
    /// test: applied to each particle that is made. For a rejected particle, another position of the shape and its
    /// direction are drawn from the same sequence, up to kMostRedraws times; a PointShape has no other position. If
    /// every try is rejected, the birth is skipped and counted by refused(). An empty test accepts all particles.
    [[nodiscard]] std::vector<Particle> births(double from, double to,
                                               std::uint64_t most = std::numeric_limits<std::uint64_t>::max(),
                                               const BirthTest& test = {});
    /// Returns the number of births so far, including rejected births.
    [[nodiscard]] std::uint64_t born() const { return schedule_.born(); }
    /// Returns the number of births that the test of births() has rejected.
    [[nodiscard]] std::uint64_t refused() const { return refused_; }

    // Parts of births(), for callers that make particles in several threads or processes.

    /// Returns the next births before the time `to`, in s, in birth order, at most `most`. born() counts them, and the
    /// next call continues after them. Throws InputError for a non-finite time.
    [[nodiscard]] std::vector<DueBirth> take_due(double to, std::uint64_t most);
    /// Skips all remaining births before the time `to`, in s. born() counts them. Throws like take_due().
    void skip_due(double to);
    /// Makes the particle of a birth in the same way as births(). Returns nothing if the test rejects every position.
    /// The function is pure, and thread-safe if the test is.
    [[nodiscard]] std::optional<Particle> make(const DueBirth& birth, const BirthTest& test) const;

    [[nodiscard]] const EmitterDescription& description() const { return description_; }
    /// Returns the number of the emitter in its scene.
    [[nodiscard]] std::uint32_t number() const { return number_; }

    /// Returns the particle drawn with the random numbers of (seed, number), born at time 0. An attribute that the
    /// description does not name has the value missing_attribute().
    [[nodiscard]] Particle draw(std::uint64_t seed, std::uint64_t number) const;
    /// Draws a particle, and new positions until the test accepts one, in the same way as births(). Returns nothing if
    /// the test rejects all positions.
    [[nodiscard]] std::optional<Particle> draw(std::uint64_t seed, std::uint64_t number, const BirthTest& test) const;
    /// Returns a uniform number in [mean - spread, mean + spread) that does not belong to a single particle. purpose:
    /// number of its stream, 0..255.
    [[nodiscard]] double draw_once(std::uint64_t seed, std::uint32_t purpose, const MeanSpread& pair) const;
    /// Returns a number of children, before rounding, drawn in the same way. The emitter must have a parent rule.
    [[nodiscard]] double draw_count(std::uint64_t seed, std::uint32_t purpose) const;
    /// Returns the index of the attribute's column; nothing if there is no such column.
    [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
    /// Returns true if the description gives values for the attribute of a column.
    [[nodiscard]] bool sets(std::size_t column) const;

private:
    struct Draw {
        Particle particle;
        double speed = 0.0;  ///< launch speed along the direction, in m/s
        Vec3 thermal;        ///< thermal velocity, in m/s, see Launch::thermal_velocity()
    };
    [[nodiscard]] Draw draw(RandomSequence& random, std::uint64_t seed, std::uint64_t number) const;
    [[nodiscard]] Vec3 draw_place(RandomSequence& random, Particle& particle) const;
    void place(RandomSequence& random, Draw& drawn) const;
    template <class Made>
    [[nodiscard]] std::optional<Particle> place_by(const BirthTest& test, RandomSequence& random, Draw& drawn,
                                                   const Made& made) const;
    [[nodiscard]] Vec3 velocity(const Draw& drawn, const Vec3& direction) const;
    [[nodiscard]] BirthPlan plan(const EmitterSurroundings& surroundings) const;
    [[nodiscard]] std::vector<AttributeValue> draw_attributes(std::uint64_t seed, std::uint64_t number) const;

    EmitterDescription description_;
    std::uint64_t seed_;
    std::uint32_t number_;
    /// Stream of this emitter's random numbers: its number, or the stream shared by all emitters with their own seed.
    std::uint32_t stream_;
    ShapeSampler shape_;
    std::vector<AttributeDescription> columns_;
    std::vector<std::size_t> attribute_columns_;  ///< columns of the description's attributes
    std::shared_ptr<const Launch> launch_;
    BirthSchedule schedule_;
    std::uint64_t refused_ = 0;
};

}  // namespace ricochet
