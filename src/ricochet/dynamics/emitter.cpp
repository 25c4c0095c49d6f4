#include "ricochet/dynamics/emitter.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/dynamics/emitter_check.h"
#include "ricochet/dynamics/launch.h"

namespace ricochet {

AttributeValue shown_value(std::span<const LifeCurve> curves, std::string_view name, const AttributeValue& value,
                           double age, double lifetime) {
    AttributeValue shown = value;
    for (const LifeCurve& curve : curves) {
        if (curve.name != name) continue;
        const double part = std::isfinite(lifetime) && lifetime > 0.0 ? age / lifetime : 0.0;
        const Vec3 factor = curve.factor.value(curve.of_lifetime ? part : age);
        for (int axis = 0; axis < 3; ++axis) shown[axis] *= factor[axis];
    }
    return shown;
}

Particle launched_from(const FrameTree& frames, std::size_t frame, Particle particle) {
    const MovingPose pose = frames.at(frame, particle.birth_time);
    const AffineMap& world = pose.world_from_frame;
    particle.velocity = world.direction(particle.velocity) + pose.velocity_of(particle.position);
    particle.position = world.point(particle.position);
    particle.spin = world.direction(particle.spin);
    if (particle.radius > 0.0) particle.spin += pose.angular_velocity;
    return particle;
}

namespace {

// Stream keys of random numbers: the high byte encodes the purpose, the lower bytes the emitter's number.
constexpr std::uint32_t kBirthStream = 0x01000000;
constexpr std::uint32_t kRateStream = 0x02000000;
constexpr std::uint32_t kRadiusStream = 0x03000000;
constexpr std::uint32_t kAttributeStream = 0x04000000;
constexpr std::uint32_t kLineageStream = 0x05000000;
constexpr std::uint32_t kSpacingStream = 0x0B000000;
constexpr std::uint32_t kStreams = 0x01000000;
constexpr std::uint32_t kOwnSeedStream = kStreams - 1;  // shared by all emitters that have their own seed

ShapeSampler sampler_of(const EmitterDescription& emitter) {
    try {
        return ShapeSampler(emitter.shape);
    } catch (const InputError& error) {
        require(false, emitter, error.what());
        throw;
    }
}

// Returns the index of an attribute's first draw in its stream. The index depends only on the attribute's name, so
// adding other attributes does not change the values.
std::uint32_t first_draw_of(std::string_view name) {
    std::uint32_t hash = 2166136261U;  // FNV-1a
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
    return hash & ~3U;  // leaves room for up to three draws
}

Vec3 clamped(const std::string& name, Vec3 value) {
    const double most = name == kSizeAttribute ? std::numeric_limits<double>::infinity() : 1.0;
    if (!looks_attribute(name)) return value;
    for (int axis = 0; axis < 3; ++axis) value[axis] = std::clamp(value[axis], 0.0, most);
    return value;
}

std::shared_ptr<const Launch> launch_of(const EmitterDescription& emitter) {
    check_emitter(emitter);
    return std::make_shared<const Launch>(emitter);
}

}  // namespace

Emitter::Emitter(EmitterDescription description, std::uint64_t seed, std::uint32_t number,
                 const EmitterSurroundings& surroundings)
    : description_(std::move(description)),
      seed_(description_.seed.value_or(seed)),
      number_(number),
      stream_(description_.seed ? kOwnSeedStream : number),
      shape_(sampler_of(description_)),
      columns_(surroundings.attributes.begin(), surroundings.attributes.end()),
      launch_(launch_of(description_)),
      schedule_(plan(surroundings)) {
    require(number < kOwnSeedStream, description_, "there are too many emitters (at most 16777215)");
    for (const AttributeSpread& attribute : description_.attributes) {
        const auto found = column(attribute.name);
        require(found.has_value(), description_, "the scene does not declare one of its attributes");
        attribute_columns_.push_back(*found);
    }
    for (const LifeCurve& curve : description_.curves) {
        require(column(curve.name).has_value(), description_, "the scene does not declare the attribute of a curve");
    }
}

BirthPlan Emitter::plan(const EmitterSurroundings& surroundings) const {
    const auto is_given = [](const MeanSpread& rate) { return rate.mean != 0.0 || rate.spread != 0.0; };
    const MeanSpread& per_frame = description_.rate_per_frame;
    const MeanSpread& per_area = description_.rate_per_area;
    const bool has_curve = !description_.rate_curve.empty();
    require(is_given(description_.rate) + is_given(per_frame) + is_given(per_area) + has_curve <= 1, description_,
            "there is more than one rate");
    require(std::isfinite(surroundings.frame_rate) && surroundings.frame_rate > 0.0, description_,
            "the frame rate must be > 0");
    BirthPlan plan{description_.burst, description_.limit, description_.start, description_.stop, description_.rate};
    plan.curve = description_.rate_curve;
    plan.spacing = description_.spacing;
    plan.seed = seed_;
    plan.rate_stream = kRateStream | stream_;
    plan.spacing_stream = kSpacingStream | stream_;
    if (!is_given(per_frame) && !is_given(per_area)) return plan;
    plan.periods_per_second = surroundings.frame_rate;
    plan.period_rate = per_frame;
    if (!is_given(per_area)) return plan;
    require(surroundings.camera.has_value(), description_, "a rate per screen area needs a reference camera");
    try {
        const double area = screen_area(description_.shape, *surroundings.camera);
        plan.period_rate = {per_area.mean * area, per_area.spread * area};
    } catch (const InputError& error) {
        require(false, description_, error.what());
    }
    return plan;
}

std::optional<std::size_t> Emitter::column(std::string_view name) const {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        if (columns_[k].name == name) return k;
    }
    return std::nullopt;
}

bool Emitter::sets(std::size_t column) const {
    return std::find(attribute_columns_.begin(), attribute_columns_.end(), column) != attribute_columns_.end();
}

std::vector<Particle> Emitter::births(double from, double to, std::uint64_t most, const BirthTest& test) {
    require(std::isfinite(from) && std::isfinite(to), description_, "the times of births must be finite");
    std::vector<Particle> made;
    if (!(from < to)) return made;
    // The list stays small, because a due birth needs far less memory than a particle.
    constexpr std::uint64_t kAtOnce = 65536;
    while (made.size() < most) {
        const std::vector<DueBirth> due = take_due(to, std::min(kAtOnce, most - made.size()));
        if (due.empty()) return made;
        for (const DueBirth& birth : due) {
            std::optional<Particle> particle = make(birth, test);
            if (particle) {
                made.push_back(std::move(*particle));
            } else {
                ++refused_;
            }
        }
    }
    skip_due(to);
    return made;
}

std::vector<DueBirth> Emitter::take_due(double to, std::uint64_t most) {
    require(std::isfinite(to), description_, "the times of births must be finite");
    return description_.parent ? std::vector<DueBirth>() : schedule_.take(to, most);
}

void Emitter::skip_due(double to) {
    require(std::isfinite(to), description_, "the times of births must be finite");
    if (!description_.parent) schedule_.skip(to);
}

double Emitter::draw_once(std::uint64_t seed, std::uint32_t purpose, const MeanSpread& pair) const {
    return RandomSequence(seed, purpose << 24 | stream_, 0).uniform_around(pair.mean, pair.spread);
}

double Emitter::draw_count(std::uint64_t seed, std::uint32_t purpose) const {
    RandomSequence random(seed, purpose << 24 | stream_, 0);
    return launch_->count(random);
}

std::optional<Particle> Emitter::make(const DueBirth& birth, const BirthTest& test) const {
    const std::uint64_t number = birth.number;
    RandomSequence random(seed_, kBirthStream | stream_, number);
    Draw drawn = draw(random, seed_, number);
    drawn.particle.birth_time = birth.time;
    drawn.particle.origin.emitter = number_;
    const auto bits = philox4x32(
        {static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32), kLineageStream | stream_, 0},
        {static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)});
    drawn.particle.origin.lineage = (std::uint64_t{bits[0]} << 32) | bits[1];
    return place_by(test, random, drawn, [&](const Particle& particle) {
        return description_.frames ? launched_from(*description_.frames, description_.frame, particle) : particle;
    });
}

// made(particle): converts the drawn particle to the one that is tested and returned.
template <class Made>
std::optional<Particle> Emitter::place_by(const BirthTest& test, RandomSequence& random, Draw& drawn,
                                          const Made& made) const {
    const int redraws = std::holds_alternative<PointShape>(description_.shape) ? 0 : kMostRedraws;
    for (int k = 0;; ++k) {
        Particle born = made(drawn.particle);
        if (!test || test(born)) return born;
        if (k == redraws) return std::nullopt;
        place(random, drawn);
    }
}

std::optional<Particle> Emitter::draw(std::uint64_t seed, std::uint64_t number, const BirthTest& test) const {
    RandomSequence random(seed, kBirthStream | stream_, number);
    Draw drawn = draw(random, seed, number);
    return place_by(test, random, drawn, [](const Particle& particle) { return particle; });
}

Particle Emitter::draw(std::uint64_t seed, std::uint64_t number) const {
    RandomSequence random(seed, kBirthStream | stream_, number);
    return draw(random, seed, number).particle;
}

Emitter::Draw Emitter::draw(RandomSequence& random, std::uint64_t seed, std::uint64_t number) const {
    Draw drawn;
    Particle& particle = drawn.particle;
    // Radii have their own stream, so giving particles a size does not change the other drawn values.
    RandomSequence radii(seed, kRadiusStream | stream_, number);
    particle.radius = launch_->radius(radii);
    const Vec3 direction = draw_place(random, particle);
    if (launch_->is_thermal()) {
        drawn.thermal = launch_->thermal_velocity(random);
    } else {
        drawn.speed = launch_->speed(random);
    }
    particle.velocity = velocity(drawn, direction);
    particle.mass = launch_->mass(particle.radius, random);
    particle.lifetime = launch_->lifetime(random);
    particle.attributes = draw_attributes(seed, number);
    return drawn;
}

Vec3 Emitter::velocity(const Draw& drawn, const Vec3& direction) const {
    if (launch_->is_thermal()) return launch_->turned(drawn.thermal, direction) + description_.velocity;
    return direction * drawn.speed + description_.velocity;
}

// Draws another position and launch direction, and keeps the drawn speed or thermal velocity.
void Emitter::place(RandomSequence& random, Draw& drawn) const {
    const Vec3 direction = draw_place(random, drawn.particle);
    drawn.particle.velocity = velocity(drawn, direction);
}

// Draws and sets the position. Returns the launch direction.
Vec3 Emitter::draw_place(RandomSequence& random, Particle& particle) const {
    const LaunchPoint launch = shape_.draw(particle.radius, random);
    particle.position = launch.position;
    const bool own_direction = description_.direction == Vec3{};
    const Vec3 axis = own_direction ? launch.direction : normalized(description_.direction);
    return launch_->is_thermal() ? axis : launch_->direction(axis, random);
}

std::vector<AttributeValue> Emitter::draw_attributes(std::uint64_t seed, std::uint64_t number) const {
    std::vector<AttributeValue> values(columns_.size(), missing_attribute());
    for (std::size_t k = 0; k < attribute_columns_.size(); ++k) {
        const AttributeSpread& attribute = description_.attributes[k];
        RandomSequence random(seed, kAttributeStream | stream_, number, first_draw_of(attribute.name));
        Vec3 value;
        for (int c = 0; c < columns_[attribute_columns_[k]].components; ++c) {
            value[c] = random.uniform_around(attribute.mean[c], attribute.spread[c]);
        }
        values[attribute_columns_[k]] = clamped(attribute.name, value);
    }
    return values;
}

}  // namespace ricochet
