#include "ricochet/dynamics/emitter_check.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {

void require(bool condition, const EmitterDescription& emitter, const char* what) {
    if (!condition) throw InputError(fmt::format("emitter '{}': {}", emitter.name, what));
}

namespace {

/// Largest drift of an effusing gas, in standard deviations of the thermal velocities. Local: a limit of input values;
/// beyond it, a speed without temperature does.
constexpr double kMostDrift = 1000.0;

bool is_spread(const MeanSpread& pair) { return std::isfinite(pair.spread) && pair.spread >= 0.0; }

// Returns true if the spread is sound. Throws InputError for a distribution out of range.
bool is_drawable(const EmitterDescription& emitter, const char* name, const DrawnValue& value) {
    if (!value.distribution) return is_spread(value);
    try {
        (void)quantile_of(value);
    } catch (const InputError& error) {
        throw InputError(fmt::format("emitter '{}': {}: {}", emitter.name, name, error.what()));
    }
    return true;
}

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

void check_parent_rule(const EmitterDescription& emitter, const ParentRule& rule) {
    require(rule.on == BirthEvent::life || rule.on == BirthEvent::death || rule.on == BirthEvent::impact ||
                rule.on == BirthEvent::birth,
            emitter, "births must be at life, death, impact or birth");
    require(is_drawable(emitter, "count", rule.count) && std::isfinite(rule.count.least()) &&
                std::isfinite(rule.count.most()),
            emitter, "the count must be finite");
    require(rule.threshold_impulse >= 0.0, emitter, "the threshold impulse must be >= 0 N s");
    require(std::isfinite(rule.inherit_velocity), emitter, "the inherited part of the velocity must be finite");
    require(rule.inherit_color >= 0.0 && rule.inherit_color <= 1.0, emitter, "the inherited colour must be 0 to 1");
    require(!rule.share || (rule.on != BirthEvent::life && rule.on != BirthEvent::birth), emitter,
            "a parent that lives on cannot be shared out");
    if (rule.cloud) check_cloud(emitter, rule);
}

void check_rates(const EmitterDescription& emitter) {
    require(std::isfinite(emitter.rate.mean) && emitter.rate.mean >= 0.0, emitter, "the rate must be finite and >= 0");
    require(is_spread(emitter.rate), emitter, "the rate's spread must be finite and >= 0");
    for (const MeanSpread& rate : {emitter.rate_per_frame, emitter.rate_per_area}) {
        require(std::isfinite(rate.mean) && is_spread(rate), emitter, "the rate must be finite");
    }
    require(emitter.spacing == BirthSpacing::regular || emitter.spacing == BirthSpacing::poisson, emitter,
            "births must be regular or poisson");
    require(!emitter.parent || (emitter.spacing == BirthSpacing::regular && emitter.rate_curve.empty()), emitter,
            "births from parents have neither a rate curve nor random times");
    const std::vector<RatePoint>& curve = emitter.rate_curve;
    for (std::size_t k = 0; k < curve.size(); ++k) {
        require(std::isfinite(curve[k].time) && (k == 0 || curve[k - 1].time < curve[k].time), emitter,
                "the times of the rate curve must increase from point to point");
        require(std::isfinite(curve[k].rate) && curve[k].rate >= 0.0, emitter, "every rate must be finite and >= 0");
    }
}

void check_body(const EmitterDescription& emitter) {
    require(is_drawable(emitter, "radius", emitter.radius) && emitter.radius.least() >= 0.0 &&
                emitter.radius.most() <= kLargestCoordinate,
            emitter, "every radius must be >= 0 and at most 1e75 m");
    require(is_drawable(emitter, "mass", emitter.mass) && std::isfinite(emitter.mass.most()) &&
                emitter.mass.least() >= kSmallestMass,
            emitter, "every mass must be at least 1e-300 kg");
    require(is_drawable(emitter, "lifetime", emitter.lifetime), emitter, "the lifetime must be >= 0 s");
    require((emitter.lifetime.distribution ? emitter.lifetime.least() : emitter.lifetime.mean) >= 0.0, emitter,
            "the lifetime must be >= 0 s");
    if (!emitter.density) return;
    require(*emitter.density > 0.0 && std::isfinite(*emitter.density), emitter, "the density must be > 0 kg/m^3");
    require(least_mass(emitter) >= kSmallestMass && std::isfinite(most_mass(emitter)), emitter,
            "the density and the radii must give masses of at least 1e-300 kg and below 1e308 kg");
    require(!emitter.parent || !emitter.parent->share, emitter, "the mass of shares follows from the parent's");
}

void check_launch(const EmitterDescription& emitter) {
    require(emitter.cone_degrees >= 0.0 && emitter.cone_degrees <= 180.0, emitter, "the cone must be 0 to 180 degrees");
    require(is_drawable(emitter, "speed", emitter.speed) && emitter.speed.least() >= -kLargestCoordinate &&
                emitter.speed.most() <= kLargestCoordinate,
            emitter, "the speed must be at most 1e75 m/s");
    require(is_finite(emitter.velocity), emitter, "the velocity must be finite");
    const bool is_cosine = emitter.direction_law == DirectionLaw::cosine;
    require(is_cosine || emitter.direction_law == DirectionLaw::uniform, emitter,
            "the direction law must be uniform or cosine");
    require(!is_cosine || (emitter.cone_degrees > 0.0 && emitter.cone_degrees <= 90.0), emitter,
            "the cosine law needs a cone above 0 and of at most 90 degrees");
    if (!emitter.thermal) return;
    const std::string problem = thermal_problem(*emitter.thermal);
    require(problem.empty(), emitter, problem.c_str());
}

void check_attributes(const EmitterDescription& emitter) {
    for (const AttributeSpread& attribute : emitter.attributes) {
        const Vec3& spread = attribute.spread;
        require(is_finite(attribute.mean) && is_finite(spread), emitter, "every attribute must be finite");
        require(std::min({spread.x, spread.y, spread.z}) >= 0.0, emitter, "every attribute's spread must be >= 0");
        const auto is_same = [&](const AttributeSpread& other) { return other.name == attribute.name; };
        require(std::count_if(emitter.attributes.begin(), emitter.attributes.end(), is_same) == 1, emitter,
                "one of its attributes is given twice");
    }
}

}  // namespace

void check_emitter(const EmitterDescription& emitter) {
    check_rates(emitter);
    check_launch(emitter);
    check_body(emitter);
    check_attributes(emitter);
    require(std::isfinite(emitter.start) && emitter.start >= 0.0, emitter, "start must be >= 0 s");
    require(!std::isnan(emitter.stop), emitter, "stop must be a time");
    const bool has_direction = length(emitter.direction) > 0.0 && std::isfinite(length(emitter.direction));
    require(emitter.direction == Vec3{} || has_direction, emitter,
            "the direction must be of finite length above 0, or zero");
    require(is_finite(emitter.velocity), emitter, "the velocity must be finite");
    // Without frames, the world is the only frame.
    const std::size_t frames = emitter.frames ? emitter.frames->size() : 1;
    require(emitter.frame < frames, emitter, "there is no such frame");
    require(!emitter.frames || !emitter.frames->is_scaled(emitter.frame), emitter,
            "its frame is scaled, expected one that keeps its size");
    if (emitter.parent) check_parent_rule(emitter, *emitter.parent);
}

std::string thermal_problem(const ThermalLaunch& thermal) {
    const bool is_effusion = thermal.law == ThermalLaw::effusion;
    if (!is_effusion && thermal.law != ThermalLaw::volume) return "the thermal law must be volume or effusion";
    const double speed = thermal.molecule_mass > 0.0 ? thermal_speed(thermal) : 0.0;
    if (!(speed > 0.0 && speed <= kLargestCoordinate)) {
        return "temperature and molecule mass must be > 0, with a thermal speed of at most 1e75 m/s";
    }
    if (!is_effusion && thermal.drift != 0.0) return "only an effusing gas has a drift; set the velocity instead";
    if (!(std::fabs(thermal.drift) <= kMostDrift * speed)) {
        return fmt::format("found a drift of {:.3g} m/s, expected at most 1000 times the thermal speed of {:.3g} m/s",
                           thermal.drift, speed);
    }
    return "";
}

double sphere_mass(double density, double radius) {
    return density * (4.0 / 3.0 * std::numbers::pi) * (radius * radius * radius);
}

double least_mass(const EmitterDescription& emitter) {
    return emitter.density ? sphere_mass(*emitter.density, emitter.radius.least()) : emitter.mass.least();
}

double most_mass(const EmitterDescription& emitter) {
    return emitter.density ? sphere_mass(*emitter.density, emitter.radius.most()) : emitter.mass.most();
}

double expected_mass(const EmitterDescription& emitter) {
    return emitter.density ? sphere_mass(*emitter.density, emitter.radius.expected()) : emitter.mass.expected();
}

double most_speed(const EmitterDescription& emitter) {
    // In standard deviations; larger deviations have a probability below 1e-7. Local: only a warning depends on it.
    constexpr double kFarthest = 6.0;
    if (emitter.thermal) return kFarthest * thermal_speed(*emitter.thermal) + std::fabs(emitter.thermal->drift);
    return std::max(std::fabs(emitter.speed.least()), std::fabs(emitter.speed.most()));
}

}  // namespace ricochet
