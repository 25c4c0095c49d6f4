#include "ricochet/dynamics/child_emitter.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/portable_math.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

constexpr std::uint32_t kCountPurpose = 0x08;
constexpr std::uint32_t kLifeRatePurpose = 0x09;
constexpr std::uint32_t kChildStream = 0x0A000000;
/// Largest number of children per event. Local: whole numbers up to this limit are exact as double and as
/// std::uint32_t.
constexpr double kMostChildren = 1e9;

// Returns the key of the random numbers for a parent's own draws or for one of its children.
std::uint64_t mixed_key(std::uint64_t lineage, std::uint32_t stream, std::uint32_t ordinal) {
    const auto bits = philox4x32({ordinal, kChildStream | stream, 0, 0},
                                 {static_cast<std::uint32_t>(lineage), static_cast<std::uint32_t>(lineage >> 32)});
    return (std::uint64_t{bits[0]} << 32) | bits[1];
}

void inherit_attributes(const Emitter& emitter, const Particle& parent, Particle& child) {
    const auto size = emitter.column(kSizeAttribute);
    const auto color = emitter.column(kColorAttribute);
    const double part = emitter.description().parent->inherit_color;
    for (std::size_t k = 0; k < child.attributes.size() && k < parent.attributes.size(); ++k) {
        if (!emitter.sets(k)) {
            if (k != size) child.attributes[k] = parent.attributes[k];
        } else if (k == color && part > 0.0) {
            child.attributes[k] = (1.0 - part) * child.attributes[k] + part * parent.attributes[k];
        }
    }
}

// Divides the mass into shares proportional to the weights. The shares and the mass are whole multiples of one unit, so
// all sums are exact. The mass must be at least the number of weights times the smallest share.
std::vector<double> shares_of(double mass, const std::vector<double>& weights) {
    int exponent = 0;
    (void)std::frexp(mass, &exponent);
    const double unit = std::ldexp(1.0, exponent - std::numeric_limits<double>::digits);
    // The smallest share, in units, is rounded down. The mass then suffices even if all shares have this size.
    const double least = std::max(1.0, std::floor(kSmallestMass / unit));
    // If the smallest share is more than one unit, every share starts with it, and only the rest is divided by weights.
    const double kept = least > 1.0 ? least : 0.0;
    const double shared = mass / unit - kept * static_cast<double>(weights.size());
    double sum = 0.0;
    for (const double weight : weights) sum += weight;
    std::vector<double> shares;
    double left = mass;
    for (const double weight : weights) {
        const double share = std::max(least, kept + std::floor(shared * (weight / sum))) * unit;
        shares.push_back(share);
        left -= share;
    }
    *std::max_element(shares.begin(), shares.end()) += left;
    return shares;
}

// Makes the launch velocities relative to the common centre of mass, and adds the parent's velocity.
void share_momentum(const Vec3& velocity, double mass, std::vector<Particle>& fragments) {
    Vec3 momentum;
    for (const Particle& fragment : fragments) momentum += fragment.mass * fragment.velocity;
    const Vec3 drift = momentum / mass;
    for (Particle& fragment : fragments) fragment.velocity += velocity - drift;
}

}  // namespace

LifeBirths births_in_life(const Emitter& emitter, const Particle& parent, double from, double to, std::uint64_t most) {
    const std::uint64_t key = mixed_key(parent.origin.lineage, emitter.number(), 0xFFFFFFFFU);
    const double rate = emitter.draw_once(key, kLifeRatePurpose, emitter.description().rate);
    LifeBirths births;
    if (!(rate > 0.0)) return births;
    const auto time_of = [&](double ordinal) { return parent.birth_time + (ordinal + 0.5) / rate; };
    // The ordinal of the first birth at or after a time is estimated, then corrected for rounding.
    const double last = std::min(kMostChildren, static_cast<double>(emitter.description().limit));
    const auto first_from = [&](double time) {
        double ordinal = std::clamp(std::floor((time - parent.birth_time) * rate - 0.5), 0.0, last);
        while (ordinal > 0.0 && time_of(ordinal - 1.0) >= time) ordinal -= 1.0;
        while (ordinal < last && time_of(ordinal) < time) ordinal += 1.0;
        return ordinal;
    };
    const double begin = first_from(from);
    const double count = std::max(0.0, first_from(to) - begin);
    const double made = std::min(count, static_cast<double>(most));
    for (double k = 0.0; k < made; k += 1.0) {
        births.first.push_back({time_of(begin + k), static_cast<std::uint32_t>(begin + k)});
    }
    births.more = static_cast<std::uint32_t>(count - made);
    return births;
}

std::uint32_t children_of_event(const Emitter& emitter, const Particle& parent, std::uint32_t event) {
    const std::uint64_t key = mixed_key(parent.origin.lineage, emitter.number(), ~event);
    const double count = emitter.draw_count(key, kCountPurpose);
    return static_cast<std::uint32_t>(std::clamp(std::floor(count + 0.5), 0.0, kMostChildren));
}

Particle make_child(const Emitter& emitter, const Particle& parent, std::uint32_t ordinal, double time) {
    const std::uint64_t lineage = mixed_key(parent.origin.lineage, emitter.number(), ordinal);
    Particle child = emitter.draw(lineage, 0);
    child.position = parent.position;
    child.velocity += emitter.description().parent->inherit_velocity * parent.velocity;
    child.birth_time = time;
    child.origin = {emitter.number(), parent.origin.generation + 1, lineage, 0, 0};
    inherit_attributes(emitter, parent, child);
    return child;
}

std::optional<CloudChild> make_cloud_child(const Emitter& emitter, const Particle& parent, std::uint32_t ordinal,
                                           double time, const BirthTest& test) {
    const std::uint64_t lineage = mixed_key(parent.origin.lineage, emitter.number(), ordinal);
    const auto in_world = [&](Particle child) {
        const Vec3 offset = child.position;
        child.position = parent.position + offset;
        child.velocity += parent.velocity + cross(emitter.description().parent->cloud->turning, offset);
        child.birth_time = time;
        return child;
    };
    std::optional<Particle> drawn =
        emitter.draw(lineage, 0, [&](const Particle& child) { return test(in_world(child)); });
    if (!drawn) return std::nullopt;
    CloudChild child{in_world(*drawn), drawn->position};
    child.particle.origin = {emitter.number(), parent.origin.generation + 1, lineage, 0, 0};
    inherit_attributes(emitter, parent, child.particle);
    return child;
}

std::uint32_t most_fragments(double mass) {
    return static_cast<std::uint32_t>(std::clamp(std::floor(mass / kSmallestMass), 1.0, kMostChildren));
}

std::vector<Particle> make_fragments(const Emitter& emitter, const Particle& parent, std::uint32_t count,
                                     std::uint32_t first_ordinal, double time) {
    Particle still = parent;
    still.velocity = {};
    std::vector<Particle> fragments;
    std::vector<double> weights;
    for (std::uint32_t k = 0; k < count; ++k) {
        fragments.push_back(make_child(emitter, still, first_ordinal + k, time));
        weights.push_back(fragments.back().mass);
    }
    const std::vector<double> masses = shares_of(parent.mass, weights);
    for (std::size_t k = 0; k < fragments.size(); ++k) {
        fragments[k].mass = masses[k];
        const double part = masses[k] / parent.mass;
        fragments[k].radius = parent.radius > 0.0 ? parent.radius * portable_pow(part, 1.0 / 3.0) : 0.0;
        fragments[k].spin = parent.spin;
    }
    share_momentum(parent.velocity, parent.mass, fragments);
    return fragments;
}

}  // namespace ricochet
