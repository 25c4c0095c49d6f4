/// \file Derivatives of fields and potentials by finite differences.
#pragma once

#include <functional>

#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"

namespace ricochet::test {

/// Returns d velocity / d axis by the sixth-order central difference, which is exact for polynomials up to degree six.
inline Vec3 flow_slope(const FlowField& flow, const Vec3& position, double time, int axis, double h) {
    constexpr double kWeights[3] = {45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0};
    Vec3 sum;
    for (int k = 1; k <= 3; ++k) {
        Vec3 before = position;
        Vec3 after = position;
        before[axis] -= k * h;
        after[axis] += k * h;
        sum += kWeights[k - 1] * (flow.velocity(after, time) - flow.velocity(before, time));
    }
    return sum / h;
}

inline double divergence(const FlowField& flow, const Vec3& position, double time, double h) {
    return flow_slope(flow, position, time, 0, h).x + flow_slope(flow, position, time, 1, h).y +
           flow_slope(flow, position, time, 2, h).z;
}

inline Vec3 vorticity(const FlowField& flow, const Vec3& position, double time, double h) {
    const Vec3 x = flow_slope(flow, position, time, 0, h);
    const Vec3 y = flow_slope(flow, position, time, 1, h);
    const Vec3 z = flow_slope(flow, position, time, 2, h);
    return {y.z - z.y, z.x - x.z, x.y - y.x};
}

/// Returns -grad U / m by the sixth-order central difference.
inline Vec3 acceleration_of_potential(const Force& force, const ForceInput& input, double h) {
    constexpr double kWeights[3] = {45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0};
    Vec3 result;
    for (int axis = 0; axis < 3; ++axis) {
        for (int k = 1; k <= 3; ++k) {
            ForceInput before = input;
            ForceInput after = input;
            before.position[axis] -= k * h;
            after.position[axis] += k * h;
            const double rise = *force.potential_energy(after) - *force.potential_energy(before);
            result[axis] -= kWeights[k - 1] * rise / (h * input.mass);
        }
    }
    return result;
}

}  // namespace ricochet::test
