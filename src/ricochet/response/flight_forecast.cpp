#include "ricochet/response/flight_forecast.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Largest duration of a step, in time steps of the run. It exceeds 1 because of the rounding of the clock. Local: only
/// look-ahead depends on it.
constexpr double kWholeStep = 1.0 + 1e-9;

/// Part of the boxes' margin by which particles may deviate from a forecast. More: forecasts of particles whose forces
/// vary quickly last longer. Less: forecasts end nearer to surfaces. Local: it affects only the cost.
constexpr double kDeviationPart = 0.125;

/// Number of steps that a forecast must last to be worth its query. Local: it affects only the cost.
constexpr double kLeastForecastSteps = 4.0;

/// An expected path beyond the end of a flight.
struct Forecast {
    Vec3 acceleration;       ///< in m/s^2
    double deviation = 0.0;  ///< in m, allowed distance from the path
    double duration = 0.0;   ///< in s, after the flight: the time for which the deviation probably suffices
};

/// Returns the estimated change of the acceleration during a flight, in m/s^2. Forces are evaluated at the flight's
/// start only, because its end can lie behind a surface, where a force need not be defined. The velocity and the time
/// are those of its end, which the next step will use. Integrators with several evaluations show the change along the
/// path, too.
Vec3 change_of_acceleration(const ResponseRules& rules, const Flight& flight) {
    ForceInput later = flight.start;
    later.velocity = flight.end_velocity;
    later.time += flight.path.duration;
    const Vec3 by_motion = rules.forces.acceleration(later) - flight.acceleration;
    if (flight.kick_duration > 0.0) return by_motion;
    const Vec3 mean = (flight.end_velocity - flight.start.velocity) / flight.path.duration;
    const Vec3 along_path = 2.0 * (mean - flight.acceleration);
    return length_squared(along_path) > length_squared(by_motion) ? along_path : by_motion;
}

/// Returns the forecast under forces that vary. The acceleration at the flight's end is extrapolated. It changes at a
/// rate j, so the trajectory leaves the parabola by about j t^3 / 6. Twice that must fit into the allowed deviation.
Forecast forecast_of(const ResponseRules& rules, const Flight& flight, double radius) {
    const Vec3 change = change_of_acceleration(rules, flight);
    Forecast forecast{flight.acceleration + change};
    forecast.deviation = kDeviationPart * std::max(0.0, rules.world.bvh_for(radius).margin() - radius);
    forecast.duration = std::cbrt(3.0 * forecast.deviation * flight.path.duration / length(change));
    return forecast;
}

/// Returns true if the flight fills the rest of a step of the run's length and belongs to the particle alone.
bool can_look_ahead(const ResponseRules& rules, const MovingParticle& particle, const Flight& flight,
                    double remaining) {
    return rules.look_ahead && particle.planned == nullptr && particle.beyond == 0.0 &&
           particle.state.coupling == nullptr && flight.path.duration == remaining &&
           remaining <= kWholeStep * rules.settings.time_step;
}

}  // namespace

std::optional<LookAhead> look_ahead_of(const ResponseRules& rules, const MovingParticle& particle, const Flight& flight,
                                       double remaining) {
    if (!can_look_ahead(rules, particle, flight, remaining)) return std::nullopt;
    const ForceInput& state = particle.state;
    const double time_step = rules.settings.time_step;
    const double left = rules.end - (state.time + remaining);  // of the run, after this step
    if (left < 0.5 * time_step) return std::nullopt;
    Forecast forecast{flight.acceleration, 0.0, ClearSpace::kForEver};
    if (!rules.forces.is_uniform()) {
        forecast = forecast_of(rules, flight, state.radius);
        if (!(forecast.duration >= kLeastForecastSteps * time_step)) return std::nullopt;
    }
    const double acceleration = length(forecast.acceleration);
    const int steps = acceleration == 0.0 ? kMaxLookAheadSteps : kMaxLookAheadStepsCurved;
    const double duration = remaining + std::min({steps * time_step, left + time_step, forecast.duration});
    LookAhead look_ahead{look_ahead_path(rules.settings.integrator, flight, forecast.acceleration, time_step, duration),
                         0.0, remaining + time_step, kWholeStep * time_step, forecast.deviation};
    const double speed = length(flight.end_velocity) + acceleration * duration;
    const double largest = max_abs(flight.path.end) + speed * duration + state.radius + forecast.deviation;
    if (!(largest < kLargestCoordinate) || !(speed < kMaxSpeed)) return std::nullopt;
    const double clocks = 4.0 * ulp(state.time + duration) * speed;  // the clock's times are rounded
    const double longest = (1.0 + kStepRounding) * time_step;
    look_ahead.margin =
        kLookAheadSlack * largest + 0.125 * longest * longest * acceleration + clocks + forecast.deviation;
    const bool begins_with_flight =
        forecast.deviation == 0.0 || space_along(look_ahead, state.time, {0.0, duration}, state.radius)
                                         .contains(flight.path, state.time, state.radius);
    return begins_with_flight ? std::optional(look_ahead) : std::nullopt;
}

ClearSpace space_along(const LookAhead& forecast, double begin, const PartOfPath& free, double radius) {
    const auto& c = forecast.path.c;
    const double t = free.from;
    return {c[0] + t * (c[1] + t * c[2]), c[1] + (2.0 * t) * c[2],    c[2], begin + t,
            begin + free.until,           radius + forecast.deviation};
}

}  // namespace ricochet
