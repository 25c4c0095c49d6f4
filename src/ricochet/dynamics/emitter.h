/// \file
/// Emitters: positions, times and initial states of births. The schedule of births depends on the emitter alone, never
/// on the time step. Each birth has its own random numbers, keyed by the particle's number within the emitter.
/// Method: W. T. Reeves, "Particle Systems: A Technique for Modeling a Class of Fuzzy Objects", ACM TOG 2(2), 1983
/// (mean and spread for every attribute).
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
#include "ricochet/dynamics/particles.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Mean and spread: values are uniform in [mean - spread, mean + spread).
struct MeanSpread {
    double mean = 0.0;
    double spread = 0.0;  ///< >= 0
};

// Births of particles from other particles.

/// Event at which a particle gives birth.
enum class BirthEvent {
    life,    ///< during its whole life, at a rate
    death,   ///< at the end of its lifetime, or when a surface absorbs it
    impact,  ///< at an impact whose impulse reaches the threshold
    birth,   ///< at its own birth
};

/// Fate of the children of a cloud when their parent ends.
enum class CloudEnd {
    free,  ///< they then fly independently
    die,   ///< they end with the parent
};

/// Children that move with their parent through flights and bounces. Each has a target position about the parent; the
/// emitter's shape gives it in coordinates about the parent. A child receives its parent's acceleration and its
/// velocity changes at impacts. The scene's forces act on a child only through its parent. Surfaces act on a child
/// directly, and it keeps the resulting motion relative to the parent.
struct CloudRule {
    Vec3 turning;       ///< angular velocity, in rad/s, of the target positions about the parent
    double pull = 0.0;  ///< acceleration towards the target per distance from it, in 1/s^2, >= 0
    double damping =
        0.0;  ///< acceleration against the velocity relative to the target, per that velocity, in 1/s, >= 0
    CloudEnd end = CloudEnd::free;
};

/// Rule by which an emitter's particles are born of other particles.
struct ParentRule {
    std::uint32_t emitter = 0;  ///< scene number of the emitter whose particles are the parents
    bool recursive = false;     ///< true: the children become parents too
    BirthEvent on = BirthEvent::life;
    MeanSpread count{1.0, 0.0};      ///< children per death, impact or birth; rounded, negative draws count as 0
    double threshold_impulse = 0.0;  ///< least impulse, in N s, of an impact that gives birth; >= 0
    /// True if the parent ends and its children share its mass and momentum. description.mass is then the weight of a
    /// share, and radii follow from masses at the parent's density. Not available for life.
    bool share = false;
    double inherit_velocity = 1.0;  ///< fraction of the parent's velocity that a child inherits; 1 when sharing
    double inherit_color = 0.0;     ///< fraction, 0..1, of the parent's colour in the child's own
    /// Not available for death or sharing. A child of a cloud inherits all of its parent's velocity.
    std::optional<CloudRule> cloud = std::nullopt;
};

// Attributes that change with a particle's age: factors keyed over its life. They are computed when a state is shown
// and never stored, so they do not depend on the time step.

/// Factor of one attribute over a particle's life.
struct LifeCurve {
    std::string name;         ///< of the attribute
    KeyedCurve<Vec3> factor;  ///< per component; a scalar attribute uses x
    /// True if the curve's time is the elapsed fraction of the lifetime, 0..1; false if it is the age, in s.
    bool of_lifetime = true;
};

/// Returns a value multiplied by the factors of all curves of that name at an age, in s. With an infinite lifetime the
/// elapsed fraction is 0.
[[nodiscard]] AttributeValue shown_value(std::span<const LifeCurve> curves, std::string_view name,
                                         const AttributeValue& value, double age, double lifetime);

// Birth positions: points, surfaces and volumes, each filled uniformly.

/// All births at one point.
struct PointShape {
    Vec3 center;
};
/// Uniform on a flat disk.
struct DiskShape {
    Vec3 center;
    Vec3 normal{0, 0, 1};  ///< not zero
    double radius = 1.0;   ///< in m, > 0
};
/// Uniform in an axis-aligned box.
struct BoxShape {
    Vec3 center;
    Vec3 size{1, 1, 1};  ///< full edge lengths, in m, >= 0
};
/// Uniform in a ball, or on its surface.
struct SphereShape {
    Vec3 center;
    double radius = 1.0;   ///< in m, > 0
    bool surface = false;  ///< true: births on the sphere itself, launched along the outward normal
};
/// Uniform by area on a triangle mesh, launched along the triangle normals.
struct MeshSurfaceShape {
    std::shared_ptr<const TriangleMesh> mesh;  ///< in world coordinates (transform already applied)
};
/// Uniform in a cone, launched along the line from the apex.
struct ConeShape {
    Vec3 apex;
    Vec3 axis{0, 0, 1};           ///< from the apex into the cone, not zero
    double angle_degrees = 20.0;  ///< between the axis and the side, 0 (a line) to below 90
    double height = 1.0;          ///< in m, > 0
};
/// Uniform in the inside of a closed mesh, decided exactly (MeshInterior).
struct MeshVolumeShape {
    std::shared_ptr<const TriangleMesh> mesh;  ///< in world coordinates
};
using EmitterShape =
    std::variant<PointShape, DiskShape, BoxShape, SphereShape, MeshSurfaceShape, ConeShape, MeshVolumeShape>;

/// Birth position with its launch direction.
struct LaunchPoint {
    Vec3 position;
    Vec3 direction;  ///< the shape's own direction, of unit length
};

class MeshInterior;

/// Draws positions in a shape.
class ShapeSampler {
public:
    /// Throws InputError, with a sentence that names the fault, for a shape outside the stated ranges and for a mesh
    /// without area. It also throws for a volume that is not closed or fills less than kSmallestFill of its box.
    explicit ShapeSampler(const EmitterShape& shape);

    /// Draws a birth position. radius: of the particle, in m; on mesh surfaces the birth keeps this distance from the
    /// surface.
    [[nodiscard]] LaunchPoint draw(double radius, RandomSequence& random) const;

    /// Smallest fraction of its box that a mesh's volume must fill, because the inside test is by rejection and must
    /// end. Local: a limit of input values.
    static constexpr double kSmallestFill = 1e-4;

private:
    [[nodiscard]] LaunchPoint on_disk(const DiskShape& disk, RandomSequence& random) const;
    [[nodiscard]] LaunchPoint in_cone(const ConeShape& cone, RandomSequence& random) const;
    [[nodiscard]] LaunchPoint on_mesh(const TriangleMesh& mesh, double radius, RandomSequence& random) const;
    [[nodiscard]] LaunchPoint in_mesh(RandomSequence& random) const;

    EmitterShape shape_;
    std::vector<double> cumulative_area_;         // of a mesh surface's triangles
    std::shared_ptr<const MeshInterior> inside_;  // of a mesh volume
    double cone_slope_ = 0.0;                     // tangent of a cone's angle
};

/// Returns points whose convex hull is that of the shape. Each circle of a round shape becomes `segments` inscribed
/// points, at least 3. For a ball only the outline seen from `seen_from` is included. Throws InputError like
/// ShapeSampler for values out of range, as do the two functions below.
[[nodiscard]] std::vector<Vec3> outline_points(const EmitterShape& shape, const Vec3& seen_from, int segments);
/// Returns a box around the shape.
[[nodiscard]] Box3 bounds(const EmitterShape& shape);

// Size of an emitter on the screen of a reference camera. This is the second rule of W. T. Reeves for the births per
// frame ("Particle Systems", ACM TOG 2(2), 1983, section 2.1): births are proportional to the screen area, so distant
// emitters cost little. The camera belongs to the scene and does not depend on rendering.

/// Pinhole camera with square pixels.
struct ReferenceCamera {
    Vec3 position;                        ///< in m
    Vec3 target{0, 0, -1};                ///< in m, different from position
    double field_of_view_degrees = 35.0;  ///< from the lower to the upper edge, 1..170
    double image_height = 720.0;          ///< pixels from the lower to the upper edge, > 0
};

/// Returns the area, in pixels, of the convex hull of the projected shape. Parts outside the image count too. The image
/// plane has the distance s = image_height / (2 tan(field_of_view / 2)), in pixels. A point at depth d and distance r
/// from the view axis is projected to s r / d. Round shapes are approximated by polygons with 256 corners.
/// Throws InputError if a part of the shape is not in front of the camera, and for a camera outside those ranges.
[[nodiscard]] double screen_area(const EmitterShape& shape, const ReferenceCamera& camera);

// Particles launched from a moving frame.

/// Returns the particle in world coordinates at its birth, launched from a frame. Its position, velocity and spin are
/// given in the frame's coordinates, relative to the frame. The frame has the rotation R, origin o and motion (v, w) at
/// the birth time. The position becomes o + R p and the velocity R u + v + w x (R p). A sphere turned with the frame
/// until then, so its spin becomes R s + w; a point has no spin. All other members are unchanged. Throws InputError
/// unless frame < frames.size().
[[nodiscard]] Particle launched_from(const FrameTree& frames, std::size_t frame, Particle particle);

// The emitter itself.

/// Mean and spread of an attribute, for each component.
struct AttributeSpread {
    std::string name;  ///< name of one of the scene's attributes, appearance included
    Vec3 mean;         ///< a scalar attribute uses x
    Vec3 spread;       ///< each component >= 0
};

/// One emitter, as described by a scene.
struct EmitterDescription {
    std::string name;
    EmitterShape shape;
    std::uint64_t burst = 0;  ///< particles born together at `start`
    MeanSpread rate;          ///< particles per second from `start` to `stop`; redrawn for every second
    /// Alternative: particles per frame (EmitterSurroundings::frame_rate), redrawn for every frame. Reeves's first
    /// method.
    MeanSpread rate_per_frame;
    /// Alternative: particles per frame and pixel of the shape's screen_area(). Reeves's second method.
    MeanSpread rate_per_area;
    double start = 0.0;                                     ///< in s
    double stop = std::numeric_limits<double>::infinity();  ///< end of the rate, in s
    /// Launch direction. Zero selects the shape's own direction: the disk, sphere or mesh normal, or a uniform random
    /// direction for point, box and ball.
    Vec3 direction;
    double cone_degrees = 0.0;  ///< half angle of the cone about the direction, uniform in solid angle, 0..180
    MeanSpread speed;           ///< in m/s
    Vec3 velocity;              ///< in m/s, added to direction * speed
    MeanSpread mass{1.0, 0.0};  ///< in kg, mean - spread > 0
    MeanSpread radius;          ///< in m, mean - spread >= 0; 0 is a point
    MeanSpread lifetime{std::numeric_limits<double>::infinity(), 0.0};  ///< in s
    std::uint64_t limit = std::numeric_limits<std::uint64_t>::max();    ///< largest total number of births
    /// Frames of the scene, or null. With a null pointer, shape, direction and velocity are in world coordinates.
    /// Otherwise they are in the coordinates of frame number `frame` at the time of birth, see launched_from().
    std::shared_ptr<const FrameTree> frames = nullptr;
    std::size_t frame = 0;
    std::vector<AttributeSpread> attributes;  ///< colours and opacities are clamped to 0..1, sizes to >= 0
    std::vector<LifeCurve> curves;            ///< factors for attributes over life, applied when a state is shown
    std::optional<std::uint64_t> seed;        ///< nothing: the scene's seed and the emitter's index in the scene
    /// Rule for births from particles. burst, start and stop are then unused, and the shape serves only the positions
    /// of a cloud.
    std::optional<ParentRule> parent;
};

/// Returns true if the emitter's particles move with their parents.
[[nodiscard]] inline bool is_cloud(const EmitterDescription& emitter) {
    return emitter.parent && emitter.parent->cloud.has_value();
}

/// Scene data that an emitter needs.
struct EmitterSurroundings {
    double frame_rate = 24.0;  ///< frames per second for rates per frame, > 0; independent of output and time step
    std::optional<ReferenceCamera> camera = std::nullopt;   ///< for rates per screen area
    std::span<const AttributeDescription> attributes = {};  ///< columns of the particles
};

/// Test of a particle in world coordinates that returns true if it may be born there. It must be pure.
using BirthTest = std::function<bool(const Particle&)>;

/// Scheduled birth.
struct DueBirth {
    std::uint64_t number = 0;  ///< within its emitter
    double time = 0.0;         ///< in s
};

/// Births of one emitter in time order.
class Emitter {
public:
    /// Number of new positions tried for a birth that the test rejects, before the birth is skipped. Fewer tries skip
    /// births in narrow spaces that have a free position. More tries cost more in spaces without one. Local, because
    /// public headers cannot include the tolerances.
    static constexpr int kMostRedraws = 64;

    /// seed: the scene's seed; number: this emitter's number in the scene, below 2^24 - 1. Throws InputError, naming
    /// the member, if the description is outside its stated ranges.
    Emitter(EmitterDescription description, std::uint64_t seed, std::uint32_t number,
            const EmitterSurroundings& surroundings = {});

    /// Returns the particles born in [from, to), in birth order, with everything set but the id, which is 0. An emitter
    /// with a parent returns none. Each call must start at the end of the last one, and the first call at 0. Throws
    /// InputError for non-finite times. The division of time into calls does not change a bit.
    ///
    /// The burst is born at `start`. After that, birth k happens when the integral of the rate since `start` passes k +
    /// 1/2. The rate is redrawn for every whole second (or frame) since `start`; negative draws count as 0.
    ///
    /// most: limit of the particles that are made and returned. Later births still count, see born().
    ///
    /// test: applied to each particle that is made. A rejected particle gets another position of the shape, with its
    /// direction, by further draws of the same sequence, up to kMostRedraws times. Everything else stays. A birth is
    /// skipped and counted by refused() if every try is rejected, or at a point, which has no other position. An empty
    /// test accepts all.
    [[nodiscard]] std::vector<Particle> births(double from, double to,
                                               std::uint64_t most = std::numeric_limits<std::uint64_t>::max(),
                                               const BirthTest& test = {});
    /// Returns the number of births so far, rejected ones included.
    [[nodiscard]] std::uint64_t born() const { return born_; }
    /// Returns the number of births that the test of births() has rejected.
    [[nodiscard]] std::uint64_t refused() const { return refused_; }

    // Steps of births(), for callers that make particles in several threads or processes.

    /// Returns the next births before `to`, in s, in birth order, at most `most`. They count as born() from now on, and
    /// the next call continues after them. An emitter with a parent returns none. Throws InputError for a non-finite
    /// time.
    [[nodiscard]] std::vector<DueBirth> take_due(double to, std::uint64_t most);
    /// Counts all remaining births before `to` as born() without making their particles. Throws like take_due().
    void skip_due(double to);
    /// Makes the particle of a birth, as births() does; returns nothing if the test rejects every position. It depends
    /// on nothing else. It is thread-safe if the test is.
    [[nodiscard]] std::optional<Particle> make(const DueBirth& birth, const BirthTest& test) const;

    [[nodiscard]] const EmitterDescription& description() const { return description_; }
    /// Returns the number of the emitter in its scene.
    [[nodiscard]] std::uint32_t number() const { return number_; }

    /// Returns the particle given by the random numbers of (seed, number), born at time 0: a pure function. Every
    /// attribute that the description does not name is missing_attribute().
    [[nodiscard]] Particle draw(std::uint64_t seed, std::uint64_t number) const;
    /// Draws a particle, and new positions as births() does until the test accepts one; returns nothing if it rejects
    /// all.
    [[nodiscard]] std::optional<Particle> draw(std::uint64_t seed, std::uint64_t number, const BirthTest& test) const;
    /// Returns a uniform number in [mean - spread, mean + spread) from a separate stream, for draws that do not belong
    /// to a single particle. purpose: 0..255.
    [[nodiscard]] double draw_once(std::uint64_t seed, std::uint32_t purpose, const MeanSpread& pair) const;
    /// Returns the index of the attribute's column; nothing if there is none.
    [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
    /// Returns true if the description gives values for the attribute of a column.
    [[nodiscard]] bool sets(std::size_t column) const;

private:
    /// Births taken from the schedule.
    struct Taken {
        std::uint64_t most;  ///< largest allowed count
        bool is_listed;      ///< true: the births are stored in `list`
        std::uint64_t count = 0;
        std::vector<DueBirth> list{};
    };
    struct Draw {
        Particle particle;
        double speed = 0.0;  ///< in m/s, along the direction
    };
    [[nodiscard]] Draw draw(RandomSequence& random, std::uint64_t seed, std::uint64_t number) const;
    [[nodiscard]] Vec3 draw_place(RandomSequence& random, Particle& particle) const;
    void place(RandomSequence& random, Draw& drawn) const;
    template <class Made>
    [[nodiscard]] std::optional<Particle> place_by(const BirthTest& test, RandomSequence& random, Draw& drawn,
                                                   const Made& made) const;
    void set_rate(const EmitterSurroundings& surroundings);
    [[nodiscard]] std::vector<AttributeValue> draw_attributes(std::uint64_t seed, std::uint64_t number) const;
    [[nodiscard]] Vec3 in_cone(const Vec3& axis, RandomSequence& random) const;
    [[nodiscard]] double rate_in_period(std::uint64_t period) const;
    void take(double to, Taken& taken);
    std::uint64_t take_at(double time, std::uint64_t count, Taken& taken);
    void take_steady(double to, Taken& taken);
    void take_redrawn(double to, Taken& taken);

    EmitterDescription description_;
    std::uint64_t seed_;
    std::uint32_t number_;
    /// Stream of its random numbers: its number, or a stream shared by emitters with their own seed.
    std::uint32_t stream_;
    ShapeSampler shape_;
    std::vector<AttributeDescription> columns_;
    std::vector<std::size_t> attribute_columns_;  ///< of the description's attributes
    double cone_height_ = 0.0;                    ///< 1 - cos(cone angle)
    MeanSpread period_rate_;                      ///< particles per period
    double periods_per_second_ = 1.0;             ///< 1, or the frame rate
    std::uint64_t born_ = 0;
    std::uint64_t refused_ = 0;
    std::uint64_t burst_born_ = 0;
    std::uint64_t period_ = 0;  ///< whole periods since start that are included in expected_
    double expected_ = 0.0;     ///< integral of the rate up to period_
    std::uint64_t rate_born_ = 0;
};

}  // namespace ricochet
