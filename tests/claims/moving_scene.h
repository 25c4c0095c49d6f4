/// \file Scenes with moving colliders, for several tests.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/frame_tree.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet::testing {

[[nodiscard]] inline FrameDescription frame_of(const std::string& name, std::vector<FrameMotion> motions,
                                               const Vec3& at = {}) {
    FrameDescription frame;
    frame.name = name;
    frame.translation = at;
    frame.motions = std::move(motions);
    return frame;
}

[[nodiscard]] inline KeyedTranslation steady(const Vec3& velocity, double until = 1000.0) {
    return {KeyedCurve<Vec3>({{0.0, {}}, {until, until * velocity}})};
}

/// Returns a frame that spins about a skew axis, swings and shakes. The amplitudes are proportional to `size`, which is
/// the size of a mesh in m.
[[nodiscard]] inline FrameDescription tumbling(double size, double spin) {
    FrameDescription frame;
    frame.name = "tumbling";
    frame.translation = {0.3 * size, -0.2 * size, 0.1 * size};
    frame.motions = {KeyedTranslation{KeyedCurve<Vec3>({{0.0, {}}, {0.4, {size, 0, 0}}, {1.0, {0, size, -size}}},
                                                       Interpolation::cubic_spline, CurveEnds::repeat)},
                     Spin{{1, 2, 3}, spin}, Swing{{0, 1, 0}, 40.0, 1.3, 20.0},
                     Oscillation{{0, 0.02 * size, 0.05 * size}, 7.0, 0.0}};
    return frame;
}

/// Returns a setup that verifies every step and records contacts.
[[nodiscard]] inline SimulationSetup setup_of(std::vector<FrameDescription> frames,
                                              std::vector<ColliderDescription> colliders, double time_step,
                                              double duration) {
    SimulationSetup setup = setup_of(time_step, duration);
    setup.options.record_contacts = true;
    setup.options.verify = true;
    setup.frames = std::make_shared<const FrameTree>(std::move(frames));
    setup.colliders = std::move(colliders);
    return setup;
}

/// Runs to the end and expects no violation. Returns all contact records.
[[nodiscard]] inline std::vector<ContactRecord> all_contacts(Simulation& simulation) {
    std::vector<ContactRecord> all;
    while (!simulation.finished()) {
        simulation.step();
        const auto& records = simulation.contact_records();
        all.insert(all.end(), records.begin(), records.end());
    }
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().energy_violations, 0U);
    return all;
}

}  // namespace ricochet::testing
