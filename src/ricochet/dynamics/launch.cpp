#include "ricochet/dynamics/launch.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ricochet/core/normal_quantile.h"
#include "ricochet/core/portable_math.h"
#include "ricochet/dynamics/numeric_quantile.h"

namespace ricochet {
namespace {

/// Cells of the distribution of effusing speeds. Local: a constant of the method, far finer than it needs.
constexpr int kEffusionCells = 256;
/// Largest value of (x - s)^2 / 2 - s^2 / 2 among the speeds, beyond which exp() is below the last bit of the sum.
/// Local: a constant of the method.
constexpr double kFarthestExponent = 45.0;

// Returns 1 - cos(angle) without cancellation at small angles.
double one_minus_cosine(double degrees) {
    if (degrees == 0.0) return 0.0;
    const double half_sine = std::sin(degrees * (3.14159265358979323846 / 360.0));
    return 2.0 * half_sine * half_sine;
}

// Returns the quantiles of the density x exp(-(x - drift)^2 / 2), x > 0: the speeds at which molecules with a drift
// pass a plane, in standard deviations. Without drift they are in closed form.
Quantile effusing_speed(double drift) {
    if (drift == 0.0) return [](double u) { return std::sqrt(-2.0 * portable_log(1.0 - u)); };
    const double farthest = drift + std::sqrt(drift * drift + 2.0 * kFarthestExponent);
    const double nearest = std::max(0.0, drift - std::sqrt(2.0 * kFarthestExponent));
    std::vector<double> cells;
    for (int k = 0; k <= kEffusionCells; ++k) {
        cells.push_back(nearest + (farthest - nearest) * (static_cast<double>(k) / kEffusionCells));
    }
    const double peak = std::max(0.0, drift);
    return NumericQuantile(
        [drift, peak](double x) { return x * portable_exp(-0.5 * (x - peak) * (x + peak - 2.0 * drift)); }, cells);
}

}  // namespace

double thermal_speed(const ThermalLaunch& thermal) {
    // In J/K, exact in the SI. Local: a constant of nature.
    constexpr double kBoltzmann = 1.380649e-23;
    return std::sqrt(kBoltzmann * thermal.temperature / thermal.molecule_mass);
}

Launch::Launch(const EmitterDescription& emitter)
    : radius_(quantile_of(emitter.radius)),
      speed_(quantile_of(emitter.speed)),
      mass_(quantile_of(emitter.mass)),
      lifetime_(quantile_of(emitter.lifetime)),
      count_(emitter.parent ? quantile_of(emitter.parent->count) : Quantile()),
      density_(emitter.density),
      law_(emitter.direction_law),
      cone_height_(one_minus_cosine(emitter.cone_degrees)),
      thermal_(emitter.thermal) {
    const double sine = sine_of_turns(emitter.cone_degrees / 360.0);
    cone_sine_squared_ = sine * sine;
    if (!thermal_) return;
    thermal_speed_ = thermal_speed(*thermal_);
    if (thermal_->law == ThermalLaw::effusion) normal_speed_ = effusing_speed(thermal_->drift / thermal_speed_);
}

// The random number of the mass is drawn in any case, so a density does not change the lifetimes.
double Launch::mass(double radius, RandomSequence& random) const {
    const double u = random.uniform();
    return density_ ? sphere_mass(*density_, radius) : mass_(u);
}

// Uniform in solid angle: by Archimedes' hat-box theorem the height along the axis is uniform. Cosine law: the squared
// sine of the angle is uniform.
Vec3 Launch::direction(const Vec3& axis, RandomSequence& random) const {
    if (law_ == DirectionLaw::uniform && cone_height_ == 0.0) return axis;
    const auto [first, second] = tangent_frame(axis);
    if (law_ == DirectionLaw::cosine) {
        const double squared = random.uniform() * cone_sine_squared_;
        const double sine = std::sqrt(squared);
        const double turns = random.uniform();
        return std::sqrt(1.0 - squared) * axis +
               sine * (sine_of_turns(turns + 0.25) * first + sine_of_turns(turns) * second);
    }
    const double height = random.uniform() * cone_height_;
    const double ring = std::sqrt(height * (2.0 - height));
    Vec3 p = random.in_unit_disk();
    while (p == Vec3{}) p = random.in_unit_disk();
    p = normalized(p);
    return axis * (1.0 - height) + ring * (first * p.x + second * p.y);
}

Vec3 Launch::thermal_velocity(RandomSequence& random) const {
    const double x = normal_of_uniform(random.uniform());
    const double y = normal_of_uniform(random.uniform());
    const double u = random.uniform();
    return thermal_speed_ * Vec3{x, y, normal_speed_ ? normal_speed_(u) : normal_of_uniform(u)};
}

Vec3 Launch::turned(const Vec3& thermal_velocity, const Vec3& direction) const {
    if (!normal_speed_) return thermal_velocity;
    const auto [first, second] = tangent_frame(direction);
    return thermal_velocity.x * first + thermal_velocity.y * second + thermal_velocity.z * direction;
}

}  // namespace ricochet
