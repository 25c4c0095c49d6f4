#include "ricochet/dynamics/emitter.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"

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
constexpr std::uint32_t kStreams = 0x01000000;
constexpr std::uint32_t kOwnSeedStream = kStreams - 1;  // shared by all emitters that have their own seed

void require(bool condition, const EmitterDescription& emitter, const char* what) {
    if (!condition) throw InputError(fmt::format("emitter '{}': {}", emitter.name, what));
}

bool is_spread(const MeanSpread& pair) { return std::isfinite(pair.spread) && pair.spread >= 0.0; }

void check_cloud(const EmitterDescription& emitter, const ParentRule& rule) {
    const CloudRule& cloud = *rule.cloud;
    require(!rule.share && rule.on != BirthEvent::death, emitter, "a cloud needs a parent that lives on");
    require(rule.inherit_velocity == 1.0, emitter, "the children of a cloud inherit all of their parent's velocity");
    require(is_finite(cloud.turning), emitter, "the turning of the cloud must be finite");
    require(std::isfinite(cloud.pull) && cloud.pull >= 0.0, emitter, "the pull of the cloud must be finite and >= 0");
    require(std::isfinite(cloud.damping) && cloud.damping >= 0.0, emitter,
            "the damping of the cloud must be finite and >= 0");
    require(cloud.end == CloudEnd::free || cloud.end == CloudEnd::die, emitter,
            "the end of the cloud must be free or die");
}

void check(const EmitterDescription& emitter, const ParentRule& rule) {
    require(rule.on == BirthEvent::life || rule.on == BirthEvent::death || rule.on == BirthEvent::impact ||
                rule.on == BirthEvent::birth,
            emitter, "births must be at life, death, impact or birth");
    require(std::isfinite(rule.count.mean) && is_spread(rule.count), emitter, "the count must be finite");
    require(rule.threshold_impulse >= 0.0, emitter, "the threshold impulse must be >= 0 N s");
    require(std::isfinite(rule.inherit_velocity), emitter, "the inherited part of the velocity must be finite");
    require(rule.inherit_color >= 0.0 && rule.inherit_color <= 1.0, emitter, "the inherited colour must be 0 to 1");
    require(!rule.share || (rule.on != BirthEvent::life && rule.on != BirthEvent::birth), emitter,
            "a parent that lives on cannot be shared out");
    if (rule.cloud) check_cloud(emitter, rule);
}

void check(const EmitterDescription& emitter) {
    require(std::isfinite(emitter.rate.mean) && emitter.rate.mean >= 0.0, emitter, "the rate must be finite and >= 0");
    require(is_spread(emitter.rate), emitter, "the rate's spread must be finite and >= 0");
    require(std::isfinite(emitter.start) && emitter.start >= 0.0, emitter, "start must be >= 0 s");
    require(!std::isnan(emitter.stop), emitter, "stop must be a time");
    const bool has_direction = length(emitter.direction) > 0.0 && std::isfinite(length(emitter.direction));
    require(emitter.direction == Vec3{} || has_direction, emitter,
            "the direction must be of finite length above 0, or zero");
    require(emitter.cone_degrees >= 0.0 && emitter.cone_degrees <= 180.0, emitter, "the cone must be 0 to 180 degrees");
    require(std::fabs(emitter.speed.mean) + emitter.speed.spread <= kLargestCoordinate && is_spread(emitter.speed),
            emitter, "the speed must be at most 1e75 m/s");
    require(is_finite(emitter.velocity), emitter, "the velocity must be finite");
    require(std::isfinite(emitter.mass.mean) && is_spread(emitter.mass) &&
                emitter.mass.mean - emitter.mass.spread >= kSmallestMass,
            emitter, "every mass must be at least 1e-300 kg");
    require(std::isfinite(emitter.radius.mean) && is_spread(emitter.radius) &&
                emitter.radius.mean >= emitter.radius.spread &&
                emitter.radius.mean + emitter.radius.spread <= kLargestCoordinate,
            emitter, "every radius must be >= 0 and at most 1e75 m");
    // Without frames, the world is the only frame.
    const std::size_t frames = emitter.frames ? emitter.frames->size() : 1;
    require(emitter.frame < frames, emitter, "there is no such frame");
    require(!emitter.frames || !emitter.frames->is_scaled(emitter.frame), emitter,
            "its frame is scaled, expected one that keeps its size");
    require(emitter.lifetime.mean >= 0.0 && is_spread(emitter.lifetime), emitter, "the lifetime must be >= 0 s");
    for (const AttributeSpread& attribute : emitter.attributes) {
        const Vec3& spread = attribute.spread;
        require(is_finite(attribute.mean) && is_finite(spread), emitter, "every attribute must be finite");
        require(std::min({spread.x, spread.y, spread.z}) >= 0.0, emitter, "every attribute's spread must be >= 0");
        const auto is_same = [&](const AttributeSpread& other) { return other.name == attribute.name; };
        require(std::count_if(emitter.attributes.begin(), emitter.attributes.end(), is_same) == 1, emitter,
                "one of its attributes is given twice");
    }
    if (emitter.parent) check(emitter, *emitter.parent);
}

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

// Returns 1 - cos(angle) without cancellation at small angles.
double one_minus_cosine(double degrees) {
    if (degrees == 0.0) return 0.0;
    const double half_sine = std::sin(degrees * (3.14159265358979323846 / 360.0));
    return 2.0 * half_sine * half_sine;
}

}  // namespace

Emitter::Emitter(EmitterDescription description, std::uint64_t seed, std::uint32_t number,
                 const EmitterSurroundings& surroundings)
    : description_(std::move(description)),
      seed_(description_.seed.value_or(seed)),
      number_(number),
      stream_(description_.seed ? kOwnSeedStream : number),
      shape_(sampler_of(description_)),
      columns_(surroundings.attributes.begin(), surroundings.attributes.end()) {
    check(description_);
    require(number < kOwnSeedStream, description_, "there are too many emitters (at most 16777215)");
    cone_height_ = one_minus_cosine(description_.cone_degrees);
    for (const AttributeSpread& attribute : description_.attributes) {
        const auto found = column(attribute.name);
        require(found.has_value(), description_, "the scene does not declare one of its attributes");
        attribute_columns_.push_back(*found);
    }
    for (const LifeCurve& curve : description_.curves) {
        require(column(curve.name).has_value(), description_, "the scene does not declare the attribute of a curve");
    }
    set_rate(surroundings);
}

void Emitter::set_rate(const EmitterSurroundings& surroundings) {
    const auto is_given = [](const MeanSpread& rate) { return rate.mean != 0.0 || rate.spread != 0.0; };
    const MeanSpread& per_frame = description_.rate_per_frame;
    const MeanSpread& per_area = description_.rate_per_area;
    for (const MeanSpread& rate : {per_frame, per_area}) {
        require(std::isfinite(rate.mean) && is_spread(rate), description_, "the rate must be finite");
    }
    require(is_given(description_.rate) + is_given(per_frame) + is_given(per_area) <= 1, description_,
            "there is more than one rate");
    period_rate_ = description_.rate;
    require(std::isfinite(surroundings.frame_rate) && surroundings.frame_rate > 0.0, description_,
            "the frame rate must be > 0");
    if (!is_given(per_frame) && !is_given(per_area)) return;
    periods_per_second_ = surroundings.frame_rate;
    period_rate_ = per_frame;
    if (!is_given(per_area)) return;
    require(surroundings.camera.has_value(), description_, "a rate per screen area needs a reference camera");
    try {
        const double area = screen_area(description_.shape, *surroundings.camera);
        period_rate_ = {per_area.mean * area, per_area.spread * area};
    } catch (const InputError& error) {
        require(false, description_, error.what());
    }
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
    Taken taken{most, true};
    take(to, taken);
    return std::move(taken.list);
}

void Emitter::skip_due(double to) {
    Taken taken{std::numeric_limits<std::uint64_t>::max(), false};
    take(to, taken);
}

void Emitter::take(double to, Taken& taken) {
    require(std::isfinite(to), description_, "the times of births must be finite");
    if (description_.parent) return;
    if (description_.start < to) {
        const std::uint64_t left = description_.burst - burst_born_;
        burst_born_ += take_at(description_.start, left, taken);
    }
    const double end = std::min(to, description_.stop);
    if (period_rate_.spread == 0.0) {
        take_steady(end, taken);
    } else {
        take_redrawn(end, taken);
    }
}

// Takes up to `count` births at the given time, within the limits of the emitter and of the call. Returns the number
// taken.
std::uint64_t Emitter::take_at(double time, std::uint64_t count, Taken& taken) {
    const std::uint64_t allowed = std::min({count, description_.limit - born_, taken.most - taken.count});
    if (taken.is_listed) {
        for (std::uint64_t i = 0; i < allowed; ++i) taken.list.push_back({born_ + i, time});
    }
    born_ += allowed;
    taken.count += allowed;
    return allowed;
}

// Takes births at a constant rate, in closed form.
void Emitter::take_steady(double to, Taken& taken) {
    const double rate = period_rate_.mean * periods_per_second_;
    if (!(rate > 0.0)) return;
    while (born_ < description_.limit && taken.count < taken.most) {
        const double time = description_.start + (static_cast<double>(rate_born_) + 0.5) / rate;
        if (time >= to) return;
        rate_born_ += take_at(time, 1, taken);
    }
}

// Takes births period by period (seconds or frames). The emitter's state remains in the last period visited, where the
// next call continues.
void Emitter::take_redrawn(double to, Taken& taken) {
    if (!(period_rate_.mean + period_rate_.spread > 0.0)) return;
    while (born_ < description_.limit && taken.count < taken.most) {
        const double rate = rate_in_period(period_);
        const double next_expected = expected_ + rate;
        const double target = static_cast<double>(rate_born_) + 0.5;
        if (target < next_expected) {
            const double fraction = (target - expected_) / rate;
            const double time = description_.start + (static_cast<double>(period_) + fraction) / periods_per_second_;
            if (time >= to) return;
            rate_born_ += take_at(time, 1, taken);
        } else {
            if (description_.start + static_cast<double>(period_ + 1) / periods_per_second_ >= to) return;
            expected_ = next_expected;
            ++period_;
        }
    }
}

double Emitter::rate_in_period(std::uint64_t period) const {
    RandomSequence random(seed_, kRateStream | stream_, period);
    return std::max(0.0, random.uniform_around(period_rate_.mean, period_rate_.spread));
}

double Emitter::draw_once(std::uint64_t seed, std::uint32_t purpose, const MeanSpread& pair) const {
    return RandomSequence(seed, purpose << 24 | stream_, 0).uniform_around(pair.mean, pair.spread);
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
    particle.radius = RandomSequence(seed, kRadiusStream | stream_, number)
                          .uniform_around(description_.radius.mean, description_.radius.spread);
    const Vec3 direction = draw_place(random, particle);
    drawn.speed = random.uniform_around(description_.speed.mean, description_.speed.spread);
    particle.velocity = direction * drawn.speed + description_.velocity;
    particle.mass = random.uniform_around(description_.mass.mean, description_.mass.spread);
    particle.lifetime = random.uniform_around(description_.lifetime.mean, description_.lifetime.spread);
    particle.attributes = draw_attributes(seed, number);
    return drawn;
}

// Draws another position and launch direction, and keeps the drawn speed.
void Emitter::place(RandomSequence& random, Draw& drawn) const {
    const Vec3 direction = draw_place(random, drawn.particle);
    drawn.particle.velocity = direction * drawn.speed + description_.velocity;
}

// Draws and sets the position. Returns the launch direction.
Vec3 Emitter::draw_place(RandomSequence& random, Particle& particle) const {
    const LaunchPoint launch = shape_.draw(particle.radius, random);
    particle.position = launch.position;
    const bool own_direction = description_.direction == Vec3{};
    const Vec3 axis = own_direction ? launch.direction : normalized(description_.direction);
    return in_cone(axis, random);
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

// Returns a direction uniform in solid angle. By Archimedes' hat-box theorem the height along the axis is uniform.
Vec3 Emitter::in_cone(const Vec3& axis, RandomSequence& random) const {
    if (cone_height_ == 0.0) return axis;
    const double height = random.uniform() * cone_height_;
    const double ring = std::sqrt(height * (2.0 - height));
    Vec3 p = random.in_unit_disk();
    while (p == Vec3{}) p = random.in_unit_disk();
    p = normalized(p);
    const auto [first, second] = tangent_frame(axis);
    return axis * (1.0 - height) + ring * (first * p.x + second * p.y);
}

}  // namespace ricochet
