/// \file
/// Private to the simulation: the path that a particle has flown in a step, as flights between knots.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/dynamics/flight.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/path.h"
#include "ricochet/response/contact_record.h"

namespace ricochet {

/// Start, impact or end of a path.
struct FlightKnot {
    double time;    ///< s
    Vec3 position;  ///< m
    Vec3 before;    ///< m/s, velocity of arrival
    Vec3 after;     ///< m/s, velocity of departure
};

/// Returns the state at a time, in s, on the cubic polynomial that matches the positions and velocities at both ends of
/// a flight. It is exact for a constant acceleration.
[[nodiscard]] inline PhaseState state_between(const FlightKnot& a, const FlightKnot& b, double time) {
    const double duration = b.time - a.time;
    if (!(duration > 0.0)) return {a.position, a.after};
    const double s = std::clamp((time - a.time) / duration, 0.0, 1.0);
    const Vec3 chord = b.position - a.position;
    const Vec3 begin = duration * a.after - chord;
    const Vec3 end = chord - duration * b.before;
    return {flush_tiny(a.position + s * (chord + (1.0 - s) * ((1.0 - s) * begin + s * end))),
            (chord + (1.0 - s) * (1.0 - 3.0 * s) * begin + s * (2.0 - 3.0 * s) * end) / duration};
}

/// Appends the impacts of a particle.
inline void add_impacts(std::vector<FlightKnot>& knots, std::span<const ContactRecord> records) {
    for (const ContactRecord& record : records) {
        knots.push_back({record.time, record.position, record.velocity_before, record.velocity_after});
    }
}

/// Returns the knots of particle i in a step. start: its state at the start. from, to: start and end of the step, in s.
/// records: its impacts, in the order of time. An impact that removes the particle is the last knot.
[[nodiscard]] inline std::vector<FlightKnot> flight_knots(const Particles& particles, std::size_t i,
                                                          const PhaseState& start, double from, double to,
                                                          std::span<const ContactRecord> records) {
    const double begin = std::max(from, particles.birth_time[i]);
    std::vector<FlightKnot> knots{{begin, start.position, start.velocity, start.velocity}};
    add_impacts(knots, records);
    if (particles.absorbed[i] != 0) return knots;
    const double end = std::max(begin, std::min(to, particles.birth_time[i] + particles.lifetime[i]));
    knots.push_back({end, particles.position[i], particles.velocity[i], particles.velocity[i]});
    return knots;
}

/// Contact records by particle. The records of one particle keep their order.
class RecordsByParticle {
public:
    explicit RecordsByParticle(std::vector<ContactRecord> records) : records_(std::move(records)) {
        std::ranges::stable_sort(records_, {}, &ContactRecord::particle);
    }
    [[nodiscard]] std::span<const ContactRecord> of(std::uint64_t id) const {
        const auto first = std::ranges::lower_bound(records_, id, {}, &ContactRecord::particle);
        return {first, std::find_if(first, records_.end(), [&](const auto& record) { return record.particle != id; })};
    }

private:
    std::vector<ContactRecord> records_;
};

}  // namespace ricochet
