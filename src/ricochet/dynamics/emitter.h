/// \file
/// Emitters: where, when and how particles are born. The schedule of births depends on the emitter alone, never on the
/// time step; each birth has its own random numbers, keyed by the particle's number within the emitter.
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

// When particles give birth to particles.

/// What a particle gives birth at.
enum class BirthEvent {
    life,    ///< all its life long, at a rate
    death,   ///< at the end of its lifetime, or when a surface absorbs it
    impact,  ///< at an impact whose impulse reaches the threshold
    birth,   ///< when it is born itself
};

/// What becomes of the children of a cloud when their parent ends.
enum class CloudEnd {
    free,  ///< from then on they fly by themselves
    die,   ///< they end with it
};

/// Children that go with their parent wherever it flies and bounces. Each has a place about it, which the emitter's
/// shape says in coordinates about the parent, and is given what the parent is given: its acceleration, and its changes
/// of velocity at impacts. Forces of the scene act by way of the parent alone. What surfaces do to a child is its own:
/// it goes on with that relative to the parent.
struct CloudRule {
    Vec3 turning;          ///< rad/s, by which places turn about the parent
    double pull = 0.0;     ///< 1/s^2, >= 0: acceleration towards its place, over the distance from it
    double damping = 0.0;  ///< 1/s, >= 0: acceleration against its velocity relative to its place, over that
    CloudEnd end = CloudEnd::free;
};

/// The rule by which an emitter's particles come from other particles.
struct ParentRule {
    std::uint32_t emitter = 0;  ///< whose particles are the parents, as its number in the scene
    bool recursive = false;     ///< the children are parents too, in turn
    BirthEvent on = BirthEvent::life;
    MeanSpread count{1.0, 0.0};      ///< children of a death, impact or birth; rounded, negative draws count as 0
    double threshold_impulse = 0.0;  ///< N s, >= 0: least impulse of an impact that gives birth
    /// The parent ends and its children share its mass and momentum: description.mass is the weight of a share,
    /// radii follow from masses at the parent's density. Not for life.
    bool share = false;
    double inherit_velocity = 1.0;  ///< part of the parent's velocity that a child begins with; 1 when sharing
    double inherit_color = 0.0;     ///< 0..1, part of the parent's colour in the child's own
    /// Not for death, nor when sharing; with it a child inherits all of the parent's velocity.
    std::optional<CloudRule> cloud = std::nullopt;
};

// Attributes that change with a particle's age: factors keyed over its life, worked out when a state is shown and
// never stored, so that they do not depend on the time step.

/// A factor for one attribute over a particle's life.
struct LifeCurve {
    std::string name;         ///< of the attribute
    KeyedCurve<Vec3> factor;  ///< of each component; of one component: x
    bool of_lifetime = true;  ///< the curve's time is the part of the lifetime that has passed, 0..1; false: the age, s
};

/// A value with the factors of all curves of that name at an age (s). A lifetime without end counts as just begun.
[[nodiscard]] AttributeValue shown_value(std::span<const LifeCurve> curves, std::string_view name,
                                         const AttributeValue& value, double age, double lifetime);

// Where particles are born: points, surfaces and volumes, each filled uniformly.

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
/// Uniform in a cone, launched along the line from the apex.
struct ConeShape {
    Vec3 apex;
    Vec3 axis{0, 0, 1};           ///< from the apex into the cone, not zero
    double angle_degrees = 20.0;  ///< between the axis and the side, 0 (a line) to below 90
    double height = 1.0;          ///< m, > 0
};
/// Uniform in the inside of a closed mesh, decided exactly (MeshInterior).
struct MeshVolumeShape {
    std::shared_ptr<const TriangleMesh> mesh;  ///< in world coordinates
};
using EmitterShape =
    std::variant<PointShape, DiskShape, BoxShape, SphereShape, MeshSurfaceShape, ConeShape, MeshVolumeShape>;

/// A position of birth.
struct LaunchPlace {
    Vec3 position;
    Vec3 direction;  ///< the shape's own, of unit length
};

class MeshInterior;

/// Draws positions in a shape.
class ShapeSampler {
public:
    /// Throws InputError, with a sentence on what is wrong, for a shape outside the ranges stated there, for a mesh
    /// without area, and for a volume that is not closed or fills less than kSmallestFill of its box.
    explicit ShapeSampler(const EmitterShape& shape);

    /// radius: of the particle, m; on mesh surfaces it is born so far off the surface.
    [[nodiscard]] LaunchPlace draw(double radius, RandomSequence& random) const;

    /// Inside test by rejection must come to an end: least part of its box that a mesh's volume has to fill.
    static constexpr double kSmallestFill = 1e-4;

private:
    [[nodiscard]] LaunchPlace on_disk(const DiskShape& disk, RandomSequence& random) const;
    [[nodiscard]] LaunchPlace in_cone(const ConeShape& cone, RandomSequence& random) const;
    [[nodiscard]] LaunchPlace on_mesh(const TriangleMesh& mesh, double radius, RandomSequence& random) const;
    [[nodiscard]] LaunchPlace in_mesh(RandomSequence& random) const;

    EmitterShape shape_;
    std::vector<double> cumulative_area_;         // of a mesh surface's triangles
    std::shared_ptr<const MeshInterior> inside_;  // of a mesh volume
    double cone_slope_ = 0.0;                     // tangent of a cone's angle
};

/// Points whose convex hull is that of the shape; round shapes by `segments` points a circle that touches from
/// inside. seen_from: of a ball only the outline seen from there counts. segments: at least 3. Throws InputError like
/// ShapeSampler for values out of range, as the two below do.
[[nodiscard]] std::vector<Vec3> outline_points(const EmitterShape& shape, const Vec3& seen_from, int segments);
/// A box around the shape.
[[nodiscard]] Box3 bounds(const EmitterShape& shape);

// How large an emitter is on the screen of a reference camera: the second rule of W. T. Reeves for how many
// particles a frame gives birth to ("Particle Systems", ACM TOG 2(2), 1983, section 2.1: so many a unit of screen
// area, so that what is far away costs little). The camera belongs to the scene and never depends on how pictures
// are made.

/// A pinhole camera with square pixels.
struct ReferenceCamera {
    Vec3 position;                        ///< m
    Vec3 target{0, 0, -1};                ///< m, different from position
    double field_of_view_degrees = 35.0;  ///< from the lower to the upper edge, 1..170
    double image_height = 720.0;          ///< pixels from the lower to the upper edge, > 0
};

/// Area of the convex hull of the shape's picture, in pixels; what lies beside the picture counts too. With s the
/// distance of the picture's plane, in pixels, s = image_height / (2 tan(field_of_view / 2)), a point at depth d
/// and distance r from the view's axis is seen at s r / d. Round shapes are taken as polygons of 256 corners.
/// Throws InputError when a part of the shape is not in front of the camera, and for a camera out of those ranges.
[[nodiscard]] double screen_area(const EmitterShape& shape, const ReferenceCamera& camera);

// Particles that are let go from a moving frame.

/// The particle as it stands in the world when it is let go from a frame at its birth time: position, velocity and
/// spin are given in the frame's coordinates, relative to the frame. With the frame's rotation R, origin o and
/// motion (v, w) at that time: position o + R p, velocity R u + v + w x (R p); a sphere was carried round by the
/// frame until then, so its spin is R s + w; a point has none. All else stays. Throws InputError unless
/// frame < frames.size().
[[nodiscard]] Particle launched_from(const FrameTree& frames, std::size_t frame, Particle particle);

// Emitters: where, when and how particles are born. The schedule of births depends on the emitter alone, never on
// the time step; each birth has its own random numbers, keyed by the particle's number within the emitter. Method:
// W. T. Reeves, "Particle Systems: A Technique for Modeling a Class of Fuzzy Objects", ACM TOG 2(2), 1983 (mean and
// spread for every attribute).

/// Mean and spread of an attribute, for each component.
struct AttributeSpread {
    std::string name;  ///< of one of the scene's attributes, those of appearance included
    Vec3 mean;         ///< of one component: x
    Vec3 spread;       ///< each component >= 0
};

/// One emitter, as a scene describes it.
struct EmitterDescription {
    std::string name;
    EmitterShape shape;
    std::uint64_t burst = 0;  ///< particles born at once at `start`
    MeanSpread rate;          ///< particles per second from `start` to `stop`; redrawn for every second
    /// Instead: particles a frame (EmitterSurroundings::frame_rate), redrawn for every frame. Reeves's first
    /// method.
    MeanSpread rate_per_frame;
    /// Instead: particles a frame for every pixel of the shape's screen_area(). Reeves's second method.
    MeanSpread rate_per_area;
    double start = 0.0;                                     ///< s
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
    /// Null pointer: shape, direction and velocity are in world coordinates. Otherwise they are in those of the
    /// frame of that number at the time of birth, and particles are let go from it, see launched_from().
    std::shared_ptr<const FrameTree> frames = nullptr;
    std::size_t frame = 0;
    std::vector<AttributeSpread> attributes;  ///< colours and opacities are clamped to 0..1, sizes to >= 0
    std::vector<LifeCurve> curves;            ///< factors for attributes over life, where a state is shown
    std::optional<std::uint64_t> seed;        ///< nothing: the scene's seed and the emitter's index in the scene
    /// Particles give birth here; burst, start and stop are not used, and the shape only for the places of a cloud.
    std::optional<ParentRule> parent;
};

/// True when its particles go with their parents.
[[nodiscard]] inline bool is_cloud(const EmitterDescription& emitter) {
    return emitter.parent && emitter.parent->cloud.has_value();
}

/// What of its scene an emitter needs.
struct EmitterSurroundings {
    double frame_rate = 24.0;  ///< frames a second of rates per frame, > 0; neither output nor time step
    std::optional<ReferenceCamera> camera = std::nullopt;   ///< of rates per screen area
    std::span<const AttributeDescription> attributes = {};  ///< columns of the particles
};

/// Whether a particle may be born as it is, with its position in the world. Pure.
using BirthTest = std::function<bool(const Particle&)>;

/// A birth that is due.
struct DueBirth {
    std::uint64_t number = 0;  ///< within its emitter
    double time = 0.0;         ///< s
};

/// The births of one emitter in time order.
class Emitter {
public:
    /// How often a birth that the test refuses is given another position, before it does not take place. Less: births
    /// in narrow rooms are refused though there is a position. More: rooms in which nothing fits cost more.
    static constexpr int kMostRedraws = 64;

    /// seed: the scene's seed; number: this emitter's number in the scene, below 2^24 - 1.
    /// Throws InputError when the description is outside the ranges stated there, naming the member.
    Emitter(EmitterDescription description, std::uint64_t seed, std::uint32_t number,
            const EmitterSurroundings& surroundings = {});

    /// Particles born in [from, to), in birth order, with everything set but the id, which is left 0. None for an
    /// emitter with a parent. Calls must go on where the last one ended, the first one begins at
    /// 0; throws InputError for times that are not finite. How the time is cut into calls changes no bit. The burst is
    /// born at `start`; after that birth k happens when the integral of the rate since `start` passes k + 1/2. The rate
    /// is drawn anew for every whole second (or frame) since `start` (negative draws count as 0). most: only the first
    /// so many are made and returned; the others are born all the same, see born(). test: of each that is made. What it
    /// refuses is given another position of the shape, with its direction, by further draws of the same sequence, up to
    /// kMostRedraws times; everything else stays. A birth that is refused every time, or at a point, where there is no
    /// other position, is left out and counted by refused(). An empty test refuses none.
    [[nodiscard]] std::vector<Particle> births(double from, double to,
                                               std::uint64_t most = std::numeric_limits<std::uint64_t>::max(),
                                               const BirthTest& test = {});
    /// Births so far, refused ones included.
    [[nodiscard]] std::uint64_t born() const { return born_; }
    /// Those of them that the test of births() has refused.
    [[nodiscard]] std::uint64_t refused() const { return refused_; }

    // What births() is made of, for those who make particles with several threads or processes.

    /// The next births before `to`, s, in birth order, at most so many. They count as born() from now on; the next call
    /// goes on behind them. None for an emitter with a parent. Throws InputError for a time that is not finite.
    [[nodiscard]] std::vector<DueBirth> take_due(double to, std::uint64_t most);
    /// All that are left before `to` count as born(), and nobody makes them. Throws as take_due() does.
    void skip_due(double to);
    /// The particle of a birth, as births() makes it; nothing where the test refuses every position. Depends on nothing
    /// else; safe from any number of threads where the test is.
    [[nodiscard]] std::optional<Particle> make(const DueBirth& birth, const BirthTest& test) const;

    [[nodiscard]] const EmitterDescription& description() const { return description_; }
    /// Number of the emitter in its scene.
    [[nodiscard]] std::uint32_t number() const { return number_; }

    /// The particle that the random numbers of (seed, number) make, born at time 0: a pure function. Every
    /// attribute that the description does not name is missing_attribute().
    [[nodiscard]] Particle draw(std::uint64_t seed, std::uint64_t number) const;
    /// The same, given other positions as births() does until the test likes it; nothing where it refuses all.
    [[nodiscard]] std::optional<Particle> draw(std::uint64_t seed, std::uint64_t number, const BirthTest& test) const;
    /// A uniform number in [mean - spread, mean + spread) from a stream of its own, for draws that are about no
    /// single particle. purpose: 0..255.
    [[nodiscard]] double draw_once(std::uint64_t seed, std::uint32_t purpose, const MeanSpread& pair) const;
    /// Number of the attribute's column; nothing when there is none.
    [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
    /// True when the description says what the attribute of a column is.
    [[nodiscard]] bool sets(std::size_t column) const;

private:
    /// Births that are taken off the schedule.
    struct Taken {
        std::uint64_t most;  ///< that may be
        bool is_listed;      ///< somebody makes them
        std::uint64_t count = 0;
        std::vector<DueBirth> list{};
    };
    struct Draw {
        Particle particle;
        double speed = 0.0;  ///< m/s, along the direction
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
    std::uint32_t stream_;  ///< of its random numbers: its number, or one of those with a seed of their own
    ShapeSampler shape_;
    std::vector<AttributeDescription> columns_;
    std::vector<std::size_t> attribute_columns_;  ///< of the description's attributes
    double cone_height_ = 0.0;                    ///< 1 - cos(cone angle)
    MeanSpread period_rate_;                      ///< particles a period
    double periods_per_second_ = 1.0;             ///< 1, or the frame rate
    std::uint64_t born_ = 0;
    std::uint64_t refused_ = 0;
    std::uint64_t burst_born_ = 0;
    std::uint64_t period_ = 0;  ///< whole periods since start that are accounted for in expected_
    double expected_ = 0.0;     ///< integral of the rate up to period_
    std::uint64_t rate_born_ = 0;
};

}  // namespace ricochet
