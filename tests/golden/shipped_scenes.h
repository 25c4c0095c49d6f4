/// \file
/// The shipped scenes whose final states are committed.
#pragma once

namespace ricochet::golden {

/// Shipped scene and the simulated part of it.
struct ShippedScene {
    const char* name;
    const char* duration;  ///< in s; empty for the whole scene
};

inline constexpr ShippedScene kShippedScenes[] = {
    {"bouncing_ball", ""},
    {"conveyor", "4"},
    {"debris", "1.6"},
    {"drops", "0.12"},
    {"fireworks", "2.2"},
    {"flow_past_body", "1.6"},
    {"fountain", "1.2"},
    {"funnel", "0.7"},
    {"galaxy", "0.6"},
    {"galton", "1.2"},
    {"gear_hail", "0.9"},
    {"marbles", "2.5"},
    {"responses/energy", ""},
    {"responses/gas", "0.25"},
    {"responses/penetration", ""},
    {"responses/slope", ""},
    {"responses/tunnelling", "0.15"},
    {"responses/wedge", ""},
    {"robot_arm", "0.9"},
    {"rope_and_cloth", "0.12"},
    {"shattering", "1.4"},
    {"sports_balls", ""},
    {"staircase", "1.5"},
    {"torus_knot_gas", "0.12"},
    {"drum", "1.2"},
    {"mixer", "1"},
    {"shaker", "0.6"},
    {"sweeper", "1.5"},
    {"turbine", "1.2"},
    {"piston", "0.4"},
    {"bouncing_table", "1.2"},
    {"fish", "2.4"},
    {"tumbling_rocks", "1.1"},
    {"billiard_break", "1"},
    {"granular_gas", "0.3"},
    {"grinder", "0.8"},
    {"fire", "0.3"},
    {"explosion", "0.3"},
    {"newtons_cradle", "1.5"},
    {"sandpile", "0.6"},
    {"hopper", "0.7"},
    {"avalanche", "1"},
    {"swarms", "1.6"},
    {"quarry", "1.2"},
};

}  // namespace ricochet::golden
