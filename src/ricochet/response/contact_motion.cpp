#include "ricochet/response/contact_motion.h"

#include <algorithm>
#include <limits>

#include "ricochet/core/double_double.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

DoubleDouble squared_length(const Vec3& v) {
    return two_product(v.x, v.x) + two_product(v.y, v.y) + two_product(v.z, v.z);
}

bool approaches_none(const Vec3& w, std::span<const Vec3> normals, double scale) {
    return std::ranges::all_of(normals, [&](const Vec3& n) { return dot(w, n) >= -kProjectionRounding * scale; });
}

/// Constants of a solid sphere. The tangential impulse that stops the slip is 2/7 of the slip momentum. The spin
/// changes by 5/2 of the velocity change over the radius. Mathematical constants.
constexpr double kSphereStick = 2.0 / 7.0;
constexpr double kSphereSpinUp = 5.0 / 2.0;

/// Returns an exponential variate of mean 1.
double exponential(RandomSequence& random) {
    for (double whole = 0.0;; whole += 1.0) {
        const double first = random.uniform();
        double last = first;
        int run = 1;
        for (;; ++run) {
            const double next = random.uniform();
            if (next >= last) break;
            last = next;
        }
        if (run % 2 == 1) return whole + first;
    }
}

/// Returns the weights of the vectors whose bits in `chosen` are set. Their weighted sum is nearest to r. At most three
/// vectors are allowed, and no two may be parallel.
std::array<double, 3> weights_of(const Vec3& r, std::span<const Vec3> n, unsigned chosen) {
    std::array<std::size_t, 3> at{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < n.size(); ++k) {
        if ((chosen >> k & 1U) != 0) at[count++] = k;
    }
    std::array<double, 3> weights{};
    const auto g = [&](std::size_t i, std::size_t j) { return dot(n[at[i]], n[at[j]]); };
    const auto b = [&](std::size_t i) { return dot(r, n[at[i]]); };
    if (count == 1) weights[at[0]] = b(0);
    if (count == 2) {
        const double c = g(0, 1);
        const double det = 1.0 - c * c;
        weights[at[0]] = (b(0) - c * b(1)) / det;
        weights[at[1]] = (b(1) - c * b(0)) / det;
    }
    if (count == 3) {
        const Vec3& u = n[at[0]];
        const Vec3& v = n[at[1]];
        const Vec3& w = n[at[2]];
        const double volume = dot(u, cross(v, w));
        weights = {dot(r, cross(v, w)) / volume, dot(r, cross(w, u)) / volume, dot(r, cross(u, v)) / volume};
    }
    return weights;
}

}  // namespace

Vec3 slip_velocity(const Motion& motion, double radius, const Vec3& n) {
    const Vec3 tangential = motion.velocity - dot(motion.velocity, n) * n;
    return radius > 0.0 ? tangential - radius * cross(motion.spin, n) : tangential;
}

Vec3 spin_change_by(const Vec3& velocity_change, const Vec3& n, double radius) {
    return radius > 0.0 ? (-kSphereSpinUp / radius) * cross(n, velocity_change) : Vec3{};
}

Motion bounce(const Motion& motion, double radius, const Vec3& n, const ImpactLaw& law) {
    const double approach = -dot(motion.velocity, n);
    if (!(approach > 0.0)) return motion;
    Motion after = motion;
    after.velocity += ((1.0 + law.restitution) * approach) * n;
    if (law.friction > 0.0) {
        const Vec3 slip = slip_velocity(motion, radius, n);
        const double speed = length(slip);
        const double most = law.friction * (1.0 + law.restitution) * approach;
        const double reversed = (1.0 + law.tangential_restitution) * speed;
        const double sticking = radius > 0.0 ? kSphereStick * reversed : reversed;
        if (speed > 0.0) {
            const double most_sticking = law.sticking_friction() * (1.0 + law.restitution) * approach;
            const Vec3 change = slip * (-(sticking <= most_sticking ? sticking : std::min(most, sticking)) / speed);
            after.velocity += change;
            if (radius > 0.0) after.spin -= (kSphereSpinUp / radius) * cross(n, change);
        }
    } else if (law.restitution == 1.0) {
        // The rounded normal is not exactly of unit length, and its error would add up over many bounces. The products
        // are exact, so that the correction itself is not biased to one side.
        const DoubleDouble gained = squared_length(motion.velocity) - squared_length(after.velocity);
        after.velocity += (0.5 * gained.hi / length_squared(after.velocity)) * after.velocity;
    }
    if (law.tangential_factor < 1.0) {
        const Vec3 along = after.velocity - dot(after.velocity, n) * n;
        after.velocity -= (1.0 - law.tangential_factor) * along;
    }
    return after;
}

Vec3 cosine_direction(const Vec3& n, RandomSequence& random) {
    // Malley's method: uniform on the disk, projected up to the hemisphere (Pharr, Jakob, Humphreys, "Physically Based
    // Rendering").
    const Vec3 disk = random.in_unit_disk();
    const auto [t, b] = tangent_frame(n);
    const double height = std::sqrt(std::max(0.0, 1.0 - disk.x * disk.x - disk.y * disk.y));
    return disk.x * t + disk.y * b + height * n;
}

Vec3 thermal_velocity(const Vec3& n, double thermal_speed, RandomSequence& random) {
    const double normal = std::sqrt(2.0 * exponential(random));
    const double tangential = std::sqrt(2.0 * exponential(random));
    Vec3 direction;
    do direction = random.in_unit_disk();
    while (direction == Vec3{});
    direction = normalized(direction);
    const auto [t, b] = tangent_frame(n);
    return thermal_speed * (normal * n + tangential * (direction.x * t + direction.y * b));
}

// The closest point of a cone of up to three half spaces lies on one of its faces: in space, on a plane, on the line of
// two planes, or at the apex. Tries all of them; the closest feasible one wins.
Vec3 project_off(const Vec3& v, std::span<const Vec3> normals) {
    normals = normals.first(std::min<std::size_t>(normals.size(), 3));
    const double scale = length(v);
    if (approaches_none(v, normals, scale)) return v;
    Vec3 best;
    double best_distance = length_squared(v);
    const auto consider = [&](const Vec3& w) {
        const double distance = length_squared(v - w);
        if (distance < best_distance && approaches_none(w, normals, scale)) {
            best = w;
            best_distance = distance;
        }
    };
    for (std::size_t i = 0; i < normals.size(); ++i) {
        consider(v - dot(v, normals[i]) * normals[i]);
        for (std::size_t j = i + 1; j < normals.size(); ++j) {
            const Vec3 line = cross(normals[i], normals[j]);
            const double size = length_squared(line);
            if (size > std::numeric_limits<double>::min()) consider((dot(v, line) / size) * line);
        }
    }
    return best;
}

// r lies in the cone of the normals. If several of its faces contain r, the one with the fewest normals wins.
std::array<double, 3> normal_accelerations(const Vec3& a, std::span<const Vec3> normals) {
    normals = normals.first(std::min<std::size_t>(normals.size(), 3));
    const Vec3 r = project_off(a, normals) - a;
    std::array<double, 3> best{};
    double best_error = length(r);
    for (const unsigned chosen : {1U, 2U, 4U, 3U, 5U, 6U, 7U}) {
        if (chosen >= 1U << normals.size()) continue;
        const std::array<double, 3> weights = weights_of(r, normals, chosen);
        Vec3 rest = r;
        bool is_pressed = true;
        for (std::size_t k = 0; k < normals.size(); ++k) {
            rest -= weights[k] * normals[k];
            is_pressed = is_pressed && weights[k] >= 0.0;
        }
        if (!is_pressed || !(length(rest) < 0.5 * best_error)) continue;
        best = weights;
        best_error = length(rest);
    }
    return best;
}

double cascade_duration(double rebound_speed, double pressing, double restitution) {
    return 2.0 * rebound_speed / ((1.0 - restitution) * pressing);
}

}  // namespace ricochet
