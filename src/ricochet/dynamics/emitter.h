/// \file
/// Emitters: where, when and how particles are born. The schedule of births depends on the emitter alone, never on the
/// time step; each birth has its own random numbers, keyed by the particle's number within the emitter.
/// Method: W. T. Reeves, "Particle Systems: A Technique for Modeling a Class of Fuzzy Objects", ACM TOG 2(2), 1983
/// (mean and spread for every attribute).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/attributes.h"
#include "ricochet/dynamics/emitter_shape.h"
#include "ricochet/dynamics/frame_tree.h"
#include "ricochet/dynamics/life_curve.h"
#include "ricochet/dynamics/mean_spread.h"
#include "ricochet/dynamics/parent_rule.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/dynamics/screen_area.h"

namespace ricochet {

/// Mean and spread of an attribute, for each component.
struct AttributeSpread {
    std::string name;  ///< of one of the scene's attributes, those for looks included
    Vec3 mean;         ///< of one component: x
    Vec3 spread;       ///< each component >= 0
};

/// One emitter, as a scene describes it.
struct EmitterDescription {
    std::string name;
    EmitterShape shape;
    std::uint64_t burst = 0;  ///< particles born at once at `start`
    MeanSpread rate;          ///< particles per second from `start` to `stop`; redrawn for every second
    /// Instead: particles a frame (EmitterSurroundings::frame_rate), redrawn for every frame. Reeves's first method.
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
    /// Null pointer: shape, direction and velocity are in world coordinates. Otherwise they are in those of the frame
    /// of that number at the time of birth, and particles are let go from it, see launched_from().
    std::shared_ptr<const FrameTree> frames = nullptr;
    std::size_t frame = 0;
    std::vector<AttributeSpread> attributes;  ///< colours and opacities are clamped to 0..1, sizes to >= 0
    std::vector<LifeCurve> curves;            ///< factors for attributes over life, where a state is shown
    std::optional<std::uint64_t> seed;        ///< nothing: the scene's seed and the emitter's place in the scene
    std::optional<ParentRule> parent;         ///< particles give birth here; shape, burst, start and stop are not used
};

/// What of its scene an emitter needs.
struct EmitterSurroundings {
    double frame_rate = 24.0;  ///< frames a second of rates per frame, > 0; neither output nor time step
    std::optional<ReferenceCamera> camera = std::nullopt;   ///< of rates per screen area
    std::span<const AttributeDescription> attributes = {};  ///< columns of the particles
};

/// The births of one emitter in time order.
class Emitter {
public:
    /// seed: the scene's seed; number: this emitter's number in the scene, below 2^24 - 1.
    /// Throws InputError when the description is outside the ranges stated there, naming the member.
    Emitter(EmitterDescription description, std::uint64_t seed, std::uint32_t number,
            const EmitterSurroundings& surroundings = {});

    /// Particles born in [from, to), in birth order, with everything set but the id, which is left 0. None for an
    /// emitter with a parent (child_emitter.h). Calls must go on where the last one ended, the first one begins at 0.
    /// How the time is cut into calls changes no bit. The burst is born at `start`; after that birth k happens when the
    /// integral of the rate since `start` passes k + 1/2. The rate is drawn anew for every whole second (or frame)
    /// since `start` (negative draws count as 0).
    [[nodiscard]] std::vector<Particle> births(double from, double to);

    [[nodiscard]] const EmitterDescription& description() const { return description_; }
    /// Number of the emitter in its scene.
    [[nodiscard]] std::uint32_t number() const { return number_; }

    /// The particle that the random numbers of (seed, number) make, born at time 0: a pure function. Every attribute
    /// that the description does not name is missing_attribute().
    [[nodiscard]] Particle draw(std::uint64_t seed, std::uint64_t number) const;
    /// A uniform number in [mean - spread, mean + spread) from a stream of its own, for draws that are about no single
    /// particle. purpose: 0..255.
    [[nodiscard]] double draw_once(std::uint64_t seed, std::uint32_t purpose, const MeanSpread& pair) const;
    /// Number of the attribute's column; nothing when there is none.
    [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
    /// True when the description says what the attribute of a column is.
    [[nodiscard]] bool sets(std::size_t column) const;

private:
    [[nodiscard]] Particle make_particle(std::uint64_t number, double time) const;
    void set_rate(const EmitterSurroundings& surroundings);
    [[nodiscard]] std::vector<AttributeValue> draw_attributes(std::uint64_t seed, std::uint64_t number) const;
    [[nodiscard]] Vec3 in_cone(const Vec3& axis, RandomSequence& random) const;
    [[nodiscard]] double rate_in_period(std::uint64_t period) const;
    void append_births(std::uint64_t count, double time, std::vector<Particle>& births);
    void append_steady_births(double to, std::vector<Particle>& births);
    void append_redrawn_births(double to, std::vector<Particle>& births);

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
    bool burst_done_ = false;
    std::uint64_t period_ = 0;  ///< whole periods since start that are accounted for in expected_
    double expected_ = 0.0;     ///< integral of the rate up to period_
    std::uint64_t rate_born_ = 0;
};

}  // namespace ricochet
