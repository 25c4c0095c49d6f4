/// \file Integration of a free particle.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "ricochet/dynamics/flight.h"

namespace ricochet::test {

/// Returns a sum of one or more forces.
template <class... Forces>
ForceField field_of(Forces... forces) {
    std::vector<std::unique_ptr<Force>> list;
    (list.push_back(std::move(forces)), ...);
    return ForceField(std::move(list));
}

/// Returns the state after `duration` s in equal steps of the classical Runge-Kutta method.
inline ForceInput carried(const ForceField& forces, ForceInput state, double duration, int steps) {
    const double h = duration / steps;
    for (int i = 0; i < steps; ++i) {
        const Flight flight = begin_flight(IntegratorKind::rk4, forces, state, h);
        state.position = flight.path.end;
        state.velocity = flight.end_velocity;
        state.time += h;
    }
    return state;
}

}  // namespace ricochet::test
