#include "ricochet/dynamics/emitter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/frame_launch.h"
#include "ricochet/geometry/predicates.h"

namespace ricochet {
namespace {

// Streams of random numbers: the high byte says what is drawn, the rest is the emitter's number.
constexpr std::uint32_t kBirthStream = 0x01000000;
constexpr std::uint32_t kRateStream = 0x02000000;
constexpr std::uint32_t kRadiusStream = 0x03000000;
constexpr std::uint32_t kStreams = 0x01000000;

void require(bool condition, const EmitterDescription& emitter, const char* what) {
    if (!condition) throw InputError(fmt::format("emitter '{}': {}", emitter.name, what));
}

bool is_spread(const MeanSpread& pair) { return std::isfinite(pair.spread) && pair.spread >= 0.0; }

void check_shape(const EmitterDescription& emitter) {
    if (const auto* disk = std::get_if<DiskShape>(&emitter.shape)) {
        require(is_finite(disk->normal) && length(disk->normal) > 0.0, emitter, "the disk's normal must not be zero");
        require(std::isfinite(disk->radius) && disk->radius > 0.0, emitter, "the disk's radius must be > 0");
    } else if (const auto* box = std::get_if<BoxShape>(&emitter.shape)) {
        const Vec3 size = box->size;
        require(is_finite(size) && std::min({size.x, size.y, size.z}) >= 0.0, emitter, "the box's size must be >= 0");
    } else if (const auto* sphere = std::get_if<SphereShape>(&emitter.shape)) {
        require(std::isfinite(sphere->radius) && sphere->radius > 0.0, emitter, "the sphere's radius must be > 0");
    } else if (const auto* surface = std::get_if<MeshSurfaceShape>(&emitter.shape)) {
        require(surface->mesh != nullptr, emitter, "the mesh is missing");
    }
}

void check(const EmitterDescription& emitter) {
    check_shape(emitter);
    require(std::isfinite(emitter.rate.mean) && is_spread(emitter.rate), emitter, "the rate must be finite");
    require(std::isfinite(emitter.start) && emitter.start >= 0.0, emitter, "start must be >= 0 s");
    require(!std::isnan(emitter.stop), emitter, "stop must be a time");
    require(is_finite(emitter.direction), emitter, "the direction must be finite");
    require(emitter.cone_degrees >= 0.0 && emitter.cone_degrees <= 180.0, emitter, "the cone must be 0 to 180 degrees");
    require(std::isfinite(emitter.speed.mean) && is_spread(emitter.speed), emitter, "the speed must be finite");
    require(is_finite(emitter.velocity), emitter, "the velocity must be finite");
    require(std::isfinite(emitter.mass.mean) && is_spread(emitter.mass) && emitter.mass.mean > emitter.mass.spread,
            emitter, "every mass must be > 0 kg");
    require(
        std::isfinite(emitter.radius.mean) && is_spread(emitter.radius) && emitter.radius.mean >= emitter.radius.spread,
        emitter, "every radius must be >= 0 m");
    require(emitter.frames == nullptr || emitter.frame < emitter.frames->size(), emitter, "there is no such frame");
    require(emitter.lifetime.mean >= 0.0 && is_spread(emitter.lifetime), emitter, "the lifetime must be >= 0 s");
}

// Running sum of the triangle areas, so that a uniform draw finds its triangle by binary search. Degenerate triangles,
// which have no normal, add nothing even where rounding gives them an area.
std::vector<double> cumulative_areas(const TriangleMesh& mesh) {
    std::vector<double> sums;
    sums.reserve(mesh.triangles.size());
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        const Vec3& b = mesh.vertices[t[1]];
        const Vec3& c = mesh.vertices[t[2]];
        if (!are_collinear(a, b, c)) sum += length(cross(b - a, c - a));
        sums.push_back(sum);
    }
    return sums;
}

// 1 - cos(angle) without cancellation at small angles.
double one_minus_cosine(double degrees) {
    if (degrees == 0.0) return 0.0;
    const double half_sine = std::sin(degrees * (3.14159265358979323846 / 360.0));
    return 2.0 * half_sine * half_sine;
}

}  // namespace

Emitter::Emitter(EmitterDescription description, std::uint64_t seed, std::uint32_t stream)
    : description_(std::move(description)), seed_(seed), stream_(stream) {
    check(description_);
    require(stream < kStreams, description_, "there are too many emitters (at most 16777216)");
    cone_height_ = one_minus_cosine(description_.cone_degrees);
    if (const auto* surface = std::get_if<MeshSurfaceShape>(&description_.shape)) {
        cumulative_area_ = cumulative_areas(*surface->mesh);
        require(!cumulative_area_.empty() && cumulative_area_.back() > 0.0, description_, "the mesh has no area");
        require(std::isfinite(cumulative_area_.back()), description_, "the mesh is too large");
    }
}

std::vector<Particle> Emitter::births(double from, double to) {
    std::vector<Particle> births;
    if (!(from < to)) return births;
    if (!burst_done_ && description_.start < to) {
        append_births(description_.burst, description_.start, births);
        burst_done_ = true;
    }
    const double end = std::min(to, description_.stop);
    if (description_.rate.spread == 0.0) {
        append_steady_births(end, births);
    } else {
        append_redrawn_births(end, births);
    }
    return births;
}

void Emitter::append_births(std::uint64_t count, double time, std::vector<Particle>& births) {
    const std::uint64_t allowed = std::min(count, description_.limit - born_);
    for (std::uint64_t i = 0; i < allowed; ++i) births.push_back(make_particle(born_++, time));
}

// A steady rate in closed form.
void Emitter::append_steady_births(double to, std::vector<Particle>& births) {
    const double rate = description_.rate.mean;
    if (!(rate > 0.0)) return;
    while (born_ < description_.limit) {
        const double time = description_.start + (static_cast<double>(rate_born_) + 0.5) / rate;
        if (time >= to) return;
        append_births(1, time, births);
        ++rate_born_;
    }
}

// Second by second; the state is left in the second in which the next birth, or the next call, falls.
void Emitter::append_redrawn_births(double to, std::vector<Particle>& births) {
    if (!(description_.rate.mean + description_.rate.spread > 0.0)) return;
    while (born_ < description_.limit) {
        const double rate = rate_in_second(second_);
        const double next_expected = expected_ + rate;
        const double target = static_cast<double>(rate_born_) + 0.5;
        if (target < next_expected) {
            const double fraction = (target - expected_) / rate;
            const double time = description_.start + (static_cast<double>(second_) + fraction);
            if (time >= to) return;
            append_births(1, time, births);
            ++rate_born_;
        } else {
            if (description_.start + static_cast<double>(second_ + 1) >= to) return;
            expected_ = next_expected;
            ++second_;
        }
    }
}

double Emitter::rate_in_second(std::uint64_t second) const {
    RandomSequence random(seed_, kRateStream | stream_, second);
    return std::max(0.0, random.uniform_around(description_.rate.mean, description_.rate.spread));
}

Particle Emitter::make_particle(std::uint64_t number, double time) const {
    RandomSequence random(seed_, kBirthStream | stream_, number);
    // Radii have a stream of their own: giving particles a size changes nothing else about their birth.
    const double radius = RandomSequence(seed_, kRadiusStream | stream_, number)
                              .uniform_around(description_.radius.mean, description_.radius.spread);
    const Launch launch = launch_from(radius, random);
    const bool own_direction = description_.direction == Vec3{};
    const Vec3 axis = own_direction ? launch.direction : normalized(description_.direction);
    const Vec3 direction = in_cone(axis, random);
    const double speed = random.uniform_around(description_.speed.mean, description_.speed.spread);
    Particle particle;
    particle.position = launch.position;
    particle.velocity = direction * speed + description_.velocity;
    particle.mass = random.uniform_around(description_.mass.mean, description_.mass.spread);
    particle.radius = radius;
    particle.birth_time = time;
    particle.lifetime = random.uniform_around(description_.lifetime.mean, description_.lifetime.spread);
    if (description_.frames) return launched_from(*description_.frames, description_.frame, particle);
    return particle;
}

Emitter::Launch Emitter::launch_from(double radius, RandomSequence& random) const {
    if (const auto* disk = std::get_if<DiskShape>(&description_.shape)) {
        const Vec3 normal = normalized(disk->normal);
        const auto [first, second] = tangent_frame(normal);
        const Vec3 p = random.in_unit_disk();
        return {disk->center + disk->radius * (first * p.x + second * p.y), normal};
    }
    if (const auto* box = std::get_if<BoxShape>(&description_.shape)) {
        Vec3 position = box->center;
        for (int axis = 0; axis < 3; ++axis) position[axis] += box->size[axis] * (random.uniform() - 0.5);
        return {position, random.unit_vector()};
    }
    if (const auto* sphere = std::get_if<SphereShape>(&description_.shape)) {
        if (!sphere->surface) return {sphere->center + sphere->radius * random.in_unit_ball(), random.unit_vector()};
        const Vec3 normal = random.unit_vector();
        return {sphere->center + sphere->radius * normal, normal};
    }
    if (const auto* surface = std::get_if<MeshSurfaceShape>(&description_.shape)) {
        return launch_from_mesh(*surface->mesh, radius, random);
    }
    return {std::get<PointShape>(description_.shape).center, random.unit_vector()};
}

// The point's rounding error is a few ulp of the corners, not of the point; a gap taken from the corners is larger.
Emitter::Launch Emitter::launch_from_mesh(const TriangleMesh& mesh, double radius, RandomSequence& random) const {
    const double area = random.uniform() * cumulative_area_.back();
    const auto found = std::upper_bound(cumulative_area_.begin(), cumulative_area_.end() - 1, area);
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(found - cumulative_area_.begin())];
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    double u = random.uniform();
    double v = random.uniform();
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    const Vec3 normal = unit_normal(a, b, c);
    const double gap = parking_gap(max(max(abs(a), abs(b)), abs(c)));
    return {a + u * (b - a) + v * (c - a) + (radius + gap) * normal, normal};
}

// Uniform in solid angle: by Archimedes' hat-box theorem the height along the axis is uniform.
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
