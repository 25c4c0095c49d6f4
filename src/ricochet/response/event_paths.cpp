#include "ricochet/response/event_paths.h"

#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/flight.h"
#include "ricochet/geometry/sweep/pair_sweep.h"

namespace ricochet {

FlownPiece free_piece(const ResponseRules& rules, const ForceInput& state, double end) {
    const Flight flight = begin_flight(rules.settings.integrator, rules.forces, state, end - state.time);
    FlownPiece trajectory = piece_of(flight);
    trajectory.begin = state.time;
    return trajectory;
}

std::optional<double> first_meeting(std::span<const FlownPiece> first, std::span<const FlownPiece> second,
                                    double distance, double slow) {
    for (std::size_t i = 0, j = 0; i < first.size() && j < second.size();) {
        const TimedPath x{&first[i].path, first[i].begin, first[i].begin + first[i].duration};
        const TimedPath y{&second[j].path, second[j].begin, second[j].begin + second[j].duration};
        if (const auto time = first_meeting(x, y, distance, slow)) return time;
        if (x.end <= y.end) ++i;
        if (y.end <= x.end) ++j;
    }
    return std::nullopt;
}

bool has_sunk(double distance, double smaller_radius, const Vec3& apart_before, const Vec3& apart_after) {
    const double after = length(apart_after);
    return after < distance - kPressedOverlap * smaller_radius && after < length(apart_before);
}

}  // namespace ricochet
