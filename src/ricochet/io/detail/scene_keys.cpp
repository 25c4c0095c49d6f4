#include "ricochet/io/detail/scene_keys.h"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/core/tolerances.h"
#include "ricochet/io/detail/attribute_keys.h"
#include "ricochet/io/detail/force_keys.h"
#include "ricochet/io/detail/key_ranges.h"
#include "ricochet/io/detail/spring_keys.h"
#include "ricochet/io/detail/suggestion.h"

namespace ricochet::detail {
namespace {

const ObjectSpec& rollback_spec() {
    static const ObjectSpec spec{
        .title = "rollback",
        .description = "Settings of the rollback response.",
        .keys = {
            {.name = "time_tolerance",
             .description = "How closely bisection brackets the time of contact.",
             .unit = "s",
             .range = kPositive,
             .fallback = "1e-9"},
            {.name = "global",
             .type = ValueType::boolean,
             .description =
                 "The whole system goes back to the earliest contact, as in textbooks, and not each particle "
                 "for itself. Costs grow with particles times contacts.",
             .fallback = "false"},
        }};
    return spec;
}

const ObjectSpec& project_spec() {
    static const ObjectSpec spec{
        .title = "project",
        .description = "Settings of the project response.",
        .keys = {
            {.name = "offset",
             .description = "Thickness of the layer on surfaces in which a particle counts as in contact, and to whose "
                            "top it is put back.",
             .unit = "m",
             .range = kLength,
             .fallback = "1e-6"},
        }};
    return spec;
}

const ObjectSpec& penalty_spec() {
    static const ObjectSpec spec{
        .title = "penalty",
        .description = "Settings of the penalty response.",
        .keys = {
            {.name = "stiffness",
             .description = "Spring constant of contacts.",
             .unit = "N/m",
             .range = kPositive,
             .without = "for each particle the one with which an undamped contact lasts contact_steps sub-steps"},
            {.name = "contact_steps",
             .description = "Sub-steps that an undamped contact lasts, where no stiffness is given.",
             .range = kPositive,
             .fallback = "20"},
            {.name = "substeps",
             .type = ValueType::integer,
             .description = "Equal parts that every step is cut into.",
             .range = {.lower = 1.0, .upper = 1e6},
             .fallback = "10"},
            {.name = "friction_speed",
             .description = "Friction grows linearly with the slip up to this speed.",
             .unit = "m/s",
             .range = kPositive,
             .fallback = "0.001"},
        }};
    return spec;
}

const ObjectSpec& tolerance_spec() {
    static const ObjectSpec spec{.title = "tolerance",
                                 .description = "What one sub-step of an adaptive integrator may be wrong by.",
                                 .keys = {
                                     {.name = "position",
                                      .description = "Of the position, also on the way between a sub-step's ends.",
                                      .unit = "m",
                                      .range = kPositive,
                                      .fallback = "1e-6"},
                                     {.name = "velocity",
                                      .description = "Of the velocity.",
                                      .unit = "m/s",
                                      .range = kPositive,
                                      .fallback = "1e-6"},
                                 }};
    return spec;
}

const ObjectSpec& simulation_spec() {
    static const ObjectSpec spec{
        .title = "simulation",
        .description = "How time is stepped and how impacts are answered.",
        .keys = {
            {.name = "time_step",
             .description = "Length of a step.",
             .unit = "s",
             .range = kPositive,
             .fallback = "0.016666666666666666"},
            {.name = "duration",
             .description = "Simulated time. The number of steps is ceil(duration / time_step - 1e-6); the last one is "
                            "shortened.",
             .unit = "s",
             .range = kNotNegative,
             .fallback = "1"},
            {.name = "integrator",
             .type = ValueType::choice,
             .description = "How particles move inside a step.",
             .fallback = "\"ballistic\"",
             .choices = {{"forward_euler", "straight lines; the velocity changes afterwards: first order"},
                         {"symplectic_euler", "the step's force first, then a straight line"},
                         {"implicit_euler",
                          "the force of the step's end first, then a straight line: first order, stable "
                          "however stiff springs and forces are"},
                         {"ballistic", "a parabola: exact when the acceleration is constant"},
                         {"midpoint", "the explicit midpoint method: second order"},
                         {"velocity_verlet",
                          "a parabola, then the mean of both ends' forces: second order, keeps energy "
                          "bounded where forces depend on position only"},
                         {"rk4", "the classical Runge-Kutta method: fourth order"},
                         {"dormand_prince",
                          "adaptive Runge-Kutta of order 5(4): each particle cuts the step by its own "
                          "error"}}},
            {.name = "tolerance",
             .type = ValueType::object,
             .description = "What one sub-step of dormand_prince may be wrong by.",
             .without = "its defaults",
             .content = &tolerance_spec()},
            {.name = "response",
             .type = ValueType::choice,
             .description = "How impacts are answered.",
             .fallback = "\"exact\"",
             .choices = {{"exact", "finds the time of impact and reflects inside the step"},
                         {"rollback", "finds a collision after the step and goes back to it"},
                         {"project", "tests at the end of the step and puts the particle back"},
                         {"penalty", "a spring and damper on the penetration"}}},
            {.name = "seed",
             .type = ValueType::integer,
             .description = "Start of all random numbers: the same seed gives the same run, to the bit.",
             .range = {.lower = 0.0, .upper = 18446744073709551615.0},
             .fallback = "0"},
            {.name = "resting_speed",
             .description = "A rebound slower than this becomes resting or sliding contact, where restitution is below "
                            "1 and something presses the particle on.",
             .unit = "m/s",
             .range = kNotNegative,
             .fallback = "0.001"},
            {.name = "frame_rate",
             .description = "Frames a second of emitters' rates per frame; neither the output's nor the time step's.",
             .unit = "1/s",
             .range = {.lower = 0.0, .upper = 1e6, .lower_open = true},
             .fallback = "24"},
            {.name = "max_depth",
             .type = ValueType::integer,
             .description = "Highest generation of particles born of particles; births beyond are refused and counted.",
             .range = kCount,
             .fallback = "16"},
            {.name = "most_particles",
             .type = ValueType::integer,
             .description = "Most particles alive at a time; births beyond are refused and counted.",
             .range = kCount,
             .fallback = "4294967295"},
            {.name = "bounce_budget",
             .type = ValueType::integer,
             .description = "Most impacts of one particle in one step. A particle that spends it stays where it is for "
                            "the rest of the step, and the time left out is counted.",
             .range = {.lower = 1.0, .upper = 4294967295.0},
             .fallback = "1000"},
            {.name = "rollback",
             .type = ValueType::object,
             .description = "Of the rollback response.",
             .without = "its defaults",
             .content = &rollback_spec()},
            {.name = "project",
             .type = ValueType::object,
             .description = "Of the project response.",
             .without = "its defaults",
             .content = &project_spec()},
            {.name = "penalty",
             .type = ValueType::object,
             .description = "Of the penalty response.",
             .without = "its defaults",
             .content = &penalty_spec()},
        }};
    return spec;
}

const ObjectSpec& material_spec() {
    static const ObjectSpec spec{
        .title = "material",
        .description = "What a surface does to what hits it.",
        .keys = {
            {.name = "restitution",
             .description = "Speed of the rebound over speed of the approach, along the normal.",
             .range = {.lower = 0.0, .upper = 1.0},
             .fallback = "1"},
            {.name = "restitution_threshold",
             .description = "Below this speed of approach the restitution falls linearly to 0.",
             .unit = "m/s",
             .range = kNotNegative,
             .fallback = "0"},
            {.name = "friction",
             .description = "Coulomb's coefficient, for impacts and for sliding.",
             .range = kNotNegative,
             .fallback = "0"},
            {.name = "rolling_friction",
             .description = "Moment that resists rolling, over radius times normal force; for particles with a radius.",
             .range = kNotNegative,
             .fallback = "0"},
            {.name = "diffuse",
             .description = "Accommodation: fraction of the impacts that are reflected by the cosine law.",
             .range = {.lower = 0.0, .upper = 1.0},
             .fallback = "0"},
            {.name = "wall_temperature",
             .description = "Diffuse reflections leave with the thermal speeds of a wall of this temperature.",
             .unit = "K",
             .range = kPositive,
             .without = "diffuse reflections keep the speed of arrival"},
            {.name = "absorption",
             .description = "Fraction of the impacts that remove the particle.",
             .range = {.lower = 0.0, .upper = 1.0},
             .fallback = "0"},
        }};
    return spec;
}

const ObjectSpec& rotation_spec() {
    static const ObjectSpec spec{.title = "rotation",
                                 .description = "A turn about an axis through the own origin, by the right-hand rule.",
                                 .keys = {
                                     {.name = "axis",
                                      .type = ValueType::vector,
                                      .description = "Direction of the axis, of any length.",
                                      .range = kCoordinate,
                                      .required = true,
                                      .not_zero = true},
                                     {.name = "degrees", .description = "Angle.", .unit = "degrees", .required = true},
                                 }};
    return spec;
}

}  // namespace

std::vector<KeySpec> placement_keys(std::string_view needs) {
    return {
        {.name = "position",
         .type = ValueType::vector,
         .description = "Where its origin is put; scale and rotation come first.",
         .unit = "m",
         .range = kCoordinate,
         .fallback = "[0, 0, 0]",
         .needs = needs},
        {.name = "rotation",
         .type = ValueType::object,
         .description = "Turns it.",
         .without = "not turned",
         .needs = needs,
         .content = &rotation_spec()},
        {.name = "scale",
         .type = ValueType::scale,
         .description = "Factor, or one for each of its own axes; a negative one mirrors.",
         .range = kCoordinate,
         .fallback = "1",
         .needs = needs},
    };
}

namespace {

KeySpec center_key() {
    return {.name = "center",
            .type = ValueType::vector,
            .description = "Its centre.",
            .unit = "m",
            .range = kCoordinate,
            .fallback = "[0, 0, 0]"};
}

KeySpec radius_key() {
    return {.name = "radius", .description = "Its radius.", .unit = "m", .range = kLength, .required = true};
}

KeySpec height_key() {
    return {.name = "height", .description = "Its height.", .unit = "m", .range = kLength, .required = true};
}

KeySpec size_key() {
    return {.name = "size",
            .type = ValueType::vector,
            .description = "Full edge lengths.",
            .unit = "m",
            .range = kLength,
            .required = true};
}

// A shape's own measures, then where it stands.
std::vector<KeySpec> placed_keys(std::vector<KeySpec> keys) {
    for (KeySpec& key : placement_keys("")) keys.push_back(std::move(key));
    return keys;
}

std::vector<KeySpec> mesh_collider_keys() {
    std::vector<KeySpec> keys = {
        {.name = "file", .type = ValueType::file, .description = "The mesh: OBJ, PLY, STL or OFF.", .required = true}};
    for (KeySpec& key : placement_keys("")) keys.push_back(std::move(key));
    keys.push_back({.name = "group_materials",
                    .type = ValueType::text_table,
                    .description =
                        "Materials of parts of an OBJ mesh: names that the file gives to its faces, each with "
                        "one of the names in `materials`. A face goes by its `usemtl` name; where that is not "
                        "listed by its `g` name (the whole line, then word by word), then by its `o` name. "
                        "Faces without a listed name take the collider's material.",
                    .without = "the collider's material everywhere"});
    keys.push_back({.name = "motion", .type = ValueType::list, .description = "Keyframes.", .built = Built::no});
    return keys;
}

const ObjectSpec& collider_spec() {
    static const ObjectSpec spec{
        .title = "collider",
        .description = "What particles bounce off. Both sides are solid.",
        .keys =
            {
                {.name = "name",
                 .type = ValueType::text,
                 .description = "For messages, reports and emitters; no two colliders share one.",
                 .without = "made from type and place in the list"},
                {.name = "material",
                 .type = ValueType::text,
                 .description = "One of the names in `materials`.",
                 .without = "restitution 1, no friction"},
            },
        .variants = {
            {.name = "plane",
             .description = "An infinite plane.",
             .keys = {{.name = "point",
                       .type = ValueType::vector,
                       .description = "A point of the plane.",
                       .unit = "m",
                       .range = kCoordinate,
                       .fallback = "[0, 0, 0]"},
                      {.name = "normal",
                       .type = ValueType::vector,
                       .description = "Its normal, of any length.",
                       .range = kCoordinate,
                       .required = true,
                       .not_zero = true}}},
            {.name = "mesh",
             .description = "A triangle mesh from a file, open or closed.",
             .keys = mesh_collider_keys()},
            {.name = "sphere",
             .description = "A ball about its own origin; an ellipsoid when the scale differs by axis.",
             .keys = placed_keys({radius_key()})},
            {.name = "cylinder",
             .description = "A cylinder with flat caps about its own z axis, its middle at the origin.",
             .keys = placed_keys({radius_key(), height_key()})},
            {.name = "box", .description = "A box about its own origin.", .keys = placed_keys({size_key()})},
        }};
    return spec;
}

std::vector<KeySpec> schedule_keys() {
    return {
        {.name = "burst",
         .type = ValueType::integer,
         .description = "Particles born at once at `start`.",
         .range = kCount,
         .fallback = "0"},
        {.name = "rate",
         .type = ValueType::pair,
         .description = "Particles a second from `start` to `stop`; drawn anew for every second.",
         .unit = "1/s",
         .range = {.lower = 0.0, .upper = 1e12},
         .fallback = "0"},
        {.name = "rate_per_frame",
         .type = ValueType::pair,
         .description =
             "Instead of `rate`: particles a frame of `simulation.frame_rate`, evenly spread inside it; drawn "
             "anew for every frame.",
         .range = {.lower = 0.0, .upper = 1e12},
         .fallback = "0"},
        {.name = "rate_per_area",
         .type = ValueType::pair,
         .description = "Instead of `rate`: particles a frame for every pixel that the shape covers in the "
                        "`reference_camera`'s picture.",
         .unit = "1/pixel",
         .range = {.lower = 0.0, .upper = 1e12},
         .fallback = "0"},
        {.name = "start", .description = "When it begins.", .unit = "s", .range = kNotNegative, .fallback = "0"},
        {.name = "stop", .description = "When the rate ends.", .unit = "s", .range = kNotNegative, .without = "never"},
        {.name = "limit",
         .type = ValueType::integer,
         .description = "Most particles ever born here; of type child: of one parent's life.",
         .range = kCount,
         .without = "no limit"},
        {.name = "seed",
         .type = ValueType::integer,
         .description = "Start of its own random numbers.",
         .range = {.lower = 0.0, .upper = 18446744073709551615.0},
         .without = "the scene's seed and the place in the list"},
    };
}

std::vector<KeySpec> launch_keys() {
    return {
        {.name = "direction",
         .type = ValueType::vector,
         .description = "Where particles are launched to.",
         .range = kCoordinate,
         .without =
             "the shape's own: the normal of a disk, of a sphere's surface or of a mesh, any direction otherwise",
         .not_zero = true},
        {.name = "cone",
         .description = "Half angle of a cone about the direction, uniform in solid angle.",
         .unit = "degrees",
         .range = {.lower = 0.0, .upper = 180.0},
         .fallback = "0"},
        {.name = "speed",
         .type = ValueType::pair,
         .description = "Along the direction.",
         .unit = "m/s",
         .range = kCoordinate,
         .fallback = "0"},
        {.name = "velocity",
         .type = ValueType::vector,
         .description = "Added to direction times speed.",
         .unit = "m/s",
         .range = kCoordinate,
         .fallback = "[0, 0, 0]"},
        {.name = "mass",
         .type = ValueType::pair,
         .description = "Mass of a particle.",
         .unit = "kg",
         .range = kPositive,
         .low_end = kPositive,
         .fallback = "1"},
        {.name = "lifetime",
         .type = ValueType::pair,
         .description = "Time after birth at which a particle is retired.",
         .unit = "s",
         .range = kNotNegative,
         .low_end = kNotNegative,
         .without = "for ever"},
        {.name = "particle_radius",
         .type = ValueType::pair,
         .description = "Radius of a particle.",
         .unit = "m",
         .range = kNotNegative,
         .low_end = kNotNegative,
         .fallback = "0"},
    };
}

std::vector<KeySpec> emitter_keys() {
    std::vector<KeySpec> keys = {{.name = "name",
                                  .type = ValueType::text,
                                  .description = "For messages and reports; no two emitters share one.",
                                  .without = "made from type and place in the list"}};
    for (KeySpec& key : schedule_keys()) keys.push_back(std::move(key));
    for (KeySpec& key : launch_keys()) keys.push_back(std::move(key));
    for (KeySpec& key : emitter_look_keys()) keys.push_back(std::move(key));
    return keys;
}

std::vector<KeySpec> child_emitter_keys() {
    return {
        {.name = "parent",
         .type = ValueType::text,
         .description = "Name of the emitter whose particles are the parents.",
         .required = true},
        {.name = "on",
         .type = ValueType::choice,
         .description = "When parents give birth.",
         .fallback = "\"life\"",
         .choices = {{"life", "all their life long, `rate` a second, one draw for each parent"},
                     {"death", "at the end of their lifetime, or absorbed by a surface"},
                     {"impact", "at impacts of at least `threshold_impulse`"}}},
        {.name = "count",
         .type = ValueType::pair,
         .description = "Children of one death or impact, rounded to whole numbers.",
         .range = {.lower = 0.0, .upper = 1e6},
         .fallback = "1"},
        {.name = "threshold_impulse",
         .description = "Least impulse of an impact that gives birth.",
         .unit = "N s",
         .range = kNotNegative,
         .fallback = "0"},
        {.name = "share",
         .type = ValueType::boolean,
         .description = "true: the parent ends and its children share its mass and momentum; `mass` is then the weight "
                        "of a share, radii follow at the same density, and `speed` says how fast they fly apart.",
         .without = "true for impact, false otherwise"},
        {.name = "recursive",
         .type = ValueType::boolean,
         .description = "true: the children are parents in the same way too, up to `simulation.max_depth`.",
         .fallback = "false"},
        {.name = "inherit_velocity",
         .description = "Part of the parent's velocity that a child begins with; 1 when sharing.",
         .range = kCoordinate,
         .fallback = "1"},
        {.name = "inherit_color",
         .description =
             "Part of the parent's colour in the child's own `color`; without a `color` the parent's is taken.",
         .range = {.lower = 0.0, .upper = 1.0},
         .fallback = "0"},
    };
}

std::vector<KeySpec> cone_emitter_keys() {
    return {
        {.name = "apex",
         .type = ValueType::vector,
         .description = "Its tip.",
         .unit = "m",
         .range = kCoordinate,
         .fallback = "[0, 0, 0]"},
        {.name = "axis",
         .type = ValueType::vector,
         .description = "From the tip into the cone, of any length.",
         .range = kCoordinate,
         .required = true,
         .not_zero = true},
        {.name = "angle",
         .description = "Between the axis and the side.",
         .unit = "degrees",
         .range = {.lower = 0.0, .upper = 89.9},
         .required = true},
        height_key(),
    };
}

std::vector<KeySpec> mesh_emitter_keys() {
    std::vector<KeySpec> keys = {
        {.name = "file", .type = ValueType::file, .description = "The mesh: OBJ, PLY, STL or OFF."},
        {.name = "collider",
         .type = ValueType::text,
         .description = "The name of a mesh collider: its surface, where it stands."}};
    for (KeySpec& key : placement_keys("file")) keys.push_back(std::move(key));
    keys.push_back({.name = "volume",
                    .type = ValueType::boolean,
                    .description = "true: uniform in the inside, launched in any direction; the mesh must be closed.",
                    .fallback = "false"});
    return keys;
}

const ObjectSpec& emitter_spec() {
    static const ObjectSpec spec{
        .title = "emitter",
        .description = "Where particles are born. A pair [mean, spread] is drawn anew for every particle.",
        .keys = emitter_keys(),
        .variants = {
            {.name = "point", .description = "All at one point.", .keys = {center_key()}},
            {.name = "disk",
             .description = "Uniform on a flat disk.",
             .keys = {center_key(),
                      {.name = "normal",
                       .type = ValueType::vector,
                       .description = "Normal of the disk, of any length.",
                       .range = kCoordinate,
                       .required = true,
                       .not_zero = true},
                      radius_key()}},
            {.name = "box",
             .description = "Uniform in a box along the axes.",
             .keys = {center_key(),
                      {.name = "size",
                       .type = ValueType::vector,
                       .description = "Full edge lengths.",
                       .unit = "m",
                       .range = {.lower = 0.0, .upper = kLargestCoordinate},
                       .required = true}}},
            {.name = "sphere",
             .description = "Uniform in a ball, or on its surface.",
             .keys = {center_key(),
                      radius_key(),
                      {.name = "surface",
                       .type = ValueType::boolean,
                       .description = "true: only on the surface, launched outward.",
                       .fallback = "false"}}},
            {.name = "mesh",
             .description = "Uniform by area on a mesh, just off its surface on the side that the triangles' normals "
                            "point to, and launched along them.",
             .keys = mesh_emitter_keys(),
             .exactly_one_of = {"file", "collider"}},
            {.name = "cone",
             .description = "Uniform in a cone, launched along the line from its tip.",
             .keys = cone_emitter_keys()},
            {.name = "child",
             .description = "Where another emitter's particles are, launched from their place and velocity; `burst`, "
                            "`start`, `stop`, `rate_per_frame` and `rate_per_area` do not apply.",
             .keys = child_emitter_keys()},
        }};
    return spec;
}

std::vector<KeySpec> particle_keys() {
    std::vector<KeySpec> keys = {
        {.name = "position",
         .type = ValueType::vector,
         .description = "Where it starts.",
         .unit = "m",
         .range = kCoordinate,
         .required = true},
        {.name = "velocity",
         .type = ValueType::vector,
         .description = "How it starts.",
         .unit = "m/s",
         .range = kCoordinate,
         .fallback = "[0, 0, 0]"},
        {.name = "mass", .description = "Its mass.", .unit = "kg", .range = kPositive, .fallback = "1"},
        {.name = "radius", .description = "Its radius.", .unit = "m", .range = kNotNegative, .fallback = "0"},
        {.name = "spin",
         .type = ValueType::vector,
         .description = "Its angular velocity; for particles with a radius.",
         .unit = "rad/s",
         .range = kCoordinate,
         .fallback = "[0, 0, 0]"},
        {.name = "pinned",
         .type = ValueType::boolean,
         .description = "true: it never moves, for springs to hang on.",
         .fallback = "false"},
    };
    for (KeySpec& key : particle_look_keys()) keys.push_back(std::move(key));
    return keys;
}

const ObjectSpec& particle_spec() {
    static const ObjectSpec spec{
        .title = "particle", .description = "Particles that are there from the start.", .keys = particle_keys()};
    return spec;
}

const ObjectSpec& reference_camera_spec() {
    static const ObjectSpec spec{
        .title = "reference camera",
        .description = "On whose screen emitters are measured; part of the scene, not of any picture.",
        .keys = {
            {.name = "position",
             .type = ValueType::vector,
             .description = "Where it stands.",
             .unit = "m",
             .range = kCoordinate,
             .required = true},
            {.name = "target",
             .type = ValueType::vector,
             .description = "The point in the middle of its picture.",
             .unit = "m",
             .range = kCoordinate,
             .required = true},
            {.name = "field_of_view",
             .description = "Angle from the lower to the upper edge.",
             .unit = "degrees",
             .range = {.lower = 1.0, .upper = 170.0},
             .fallback = "35"},
            {.name = "image_height",
             .description = "Pixels from the lower to the upper edge.",
             .range = {.lower = 1.0, .upper = 1e6},
             .fallback = "720"},
        }};
    return spec;
}

const ObjectSpec& bounds_spec() {
    static const ObjectSpec spec{.title = "bounds",
                                 .description = "A box in world coordinates; particles that leave it are retired.",
                                 .keys = {
                                     {.name = "lower",
                                      .type = ValueType::vector,
                                      .description = "Its corner with the smallest coordinates.",
                                      .unit = "m",
                                      .range = kCoordinate,
                                      .required = true},
                                     {.name = "upper",
                                      .type = ValueType::vector,
                                      .description = "Its corner with the largest coordinates, each above `lower`'s.",
                                      .unit = "m",
                                      .range = kCoordinate,
                                      .required = true},
                                 }};
    return spec;
}

const ObjectSpec& output_spec() {
    static const ObjectSpec spec{
        .title = "output",
        .description = "What a run writes.",
        .keys = {
            {.name = "format",
             .type = ValueType::choice,
             .description = "Of the frames.",
             .fallback = "\"vtp\"",
             .choices = {{"vtp", "VTK XML polygon data, with a .pvd index, for ParaView and Blender"}}},
            {.name = "every",
             .type = ValueType::integer,
             .description = "Steps from one frame to the next. The last state is always written.",
             .range = {.lower = 1.0, .upper = 4294967295.0},
             .fallback = "1"},
            {.name = "contacts",
             .type = ValueType::boolean,
             .description = "Write every impact, as points with their columns, once a frame.",
             .fallback = "false"},
        }};
    return spec;
}

const ObjectSpec& camera_spec() {
    static const ObjectSpec spec{.title = "camera",
                                 .description = "Where `ricochet render` looks from, unless it is told otherwise.",
                                 .keys = {
                                     {.name = "position",
                                      .type = ValueType::vector,
                                      .description = "Where it stands.",
                                      .unit = "m",
                                      .range = kCoordinate,
                                      .required = true},
                                     {.name = "target",
                                      .type = ValueType::vector,
                                      .description = "The point in the middle of the picture.",
                                      .unit = "m",
                                      .range = kCoordinate,
                                      .required = true},
                                     {.name = "up",
                                      .type = ValueType::vector,
                                      .description = "What is up in the picture.",
                                      .range = kCoordinate,
                                      .without = "against gravity",
                                      .not_zero = true},
                                     {.name = "field_of_view",
                                      .description = "Angle from the lower to the upper edge.",
                                      .unit = "degrees",
                                      .range = {.lower = 1.0, .upper = 170.0},
                                      .fallback = "35"},
                                 }};
    return spec;
}

std::vector<KeySpec> scene_keys() {
    return {
        {.name = "ricochet",
         .type = ValueType::integer,
         .description = "Version of the scene format.",
         .range = {.lower = kSceneVersion, .upper = kSceneVersion},
         .required = true},
        {.name = "$schema",
         .type = ValueType::text,
         .description = "For editors; not used here.",
         .without = "no help from the editor"},
        {.name = "simulation",
         .type = ValueType::object,
         .description = "Time and impacts.",
         .without = "all its defaults",
         .content = &simulation_spec()},
        {.name = "forces",
         .type = ValueType::list,
         .description = "Forces on the particles.",
         .fallback = "[]",
         .content = &force_spec()},
        {.name = "flows",
         .type = ValueType::table,
         .description = "Flows by name, for several forces to share.",
         .fallback = "{}",
         .content = &flow_spec()},
        {.name = "materials",
         .type = ValueType::table,
         .description = "Materials by name.",
         .fallback = "{}",
         .content = &material_spec()},
        {.name = "colliders",
         .type = ValueType::list,
         .description = "What particles bounce off.",
         .fallback = "[]",
         .content = &collider_spec()},
        {.name = "emitters",
         .type = ValueType::list,
         .description = "Where particles are born.",
         .fallback = "[]",
         .content = &emitter_spec()},
        {.name = "particles",
         .type = ValueType::list_or_file,
         .description = "Particles that are there from the start, one by one or from a table.",
         .fallback = "[]",
         .content = &particle_spec()},
        {.name = "springs",
         .type = ValueType::list,
         .description = "Springs between particles; ropes, chains and cloth with particles of their own.",
         .fallback = "[]",
         .content = &springs_spec()},
        {.name = "attributes",
         .type = ValueType::table,
         .description = "Values of your own that particles carry, by name.",
         .fallback = "{}",
         .content = &attribute_spec()},
        {.name = "reference_camera",
         .type = ValueType::object,
         .description = "For emitters' rates per screen area.",
         .without = "no such rates",
         .content = &reference_camera_spec()},
        {.name = "bounds",
         .type = ValueType::object,
         .description = "Where particles are retired.",
         .without = "nowhere",
         .content = &bounds_spec()},
        {.name = "output",
         .type = ValueType::object,
         .description = "What is written.",
         .without = "all its defaults",
         .content = &output_spec()},
        {.name = "camera",
         .type = ValueType::object,
         .description = "For pictures.",
         .without = "a camera that sees everything",
         .content = &camera_spec()},
    };
}

std::string number_words(const KeySpec& key, std::string_view noun) {
    std::string words(noun);
    if (key.built == Built::only_zero) return "0";
    if (key.range.lower == key.range.upper) return fmt::format("{}", key.range.lower);
    if (const std::string range = range_words(key.range); !range.empty()) words += " " + range;
    if (!key.unit.empty()) words += fmt::format(" ({})", key.unit);
    return words;
}

std::string vector_words(const KeySpec& key) {
    std::string words = "[x, y, z]";
    if (key.not_zero) words += ", not all zero";
    if (const std::string range = range_words(key.range); !range.empty()) words += ", each " + range;
    if (!key.unit.empty()) words += fmt::format(" ({})", key.unit);
    return words;
}

std::string pair_words(const KeySpec& key) {
    std::string words = number_words(key, "a number");
    if (key.built == Built::only_zero) return words;
    words += " or [mean, spread] with spread >= 0";
    if (const std::string low = range_words(key.low_end); !low.empty()) words += " and mean - spread " + low;
    return words;
}

std::string choice_words(const KeySpec& key) {
    std::vector<std::string_view> names;
    for (const Choice& choice : key.choices) {
        if (choice.built == Built::yes) names.push_back(choice.name);
    }
    return names.size() == 1 ? quoted_list(names) : "one of " + quoted_list(names);
}

}  // namespace

const ObjectSpec& scene_spec() {
    static const ObjectSpec spec{.title = "scene", .description = "A whole scene.", .keys = scene_keys()};
    return spec;
}

const ObjectSpec& particle_file_spec() {
    static const ObjectSpec spec{
        .title = "particle table",
        .description = "Particles from a file.",
        .keys = {{.name = "file",
                  .type = ValueType::file,
                  .description =
                      "A .csv file: a header line that names the columns (x, y, z and, where wanted, vx, vy, "
                      "vz, mass, radius), then one line a particle.",
                  .required = true}}};
    return spec;
}

std::vector<const KeySpec*> keys_of(const ObjectSpec& object, const Variant* variant) {
    std::vector<const KeySpec*> keys;
    for (const KeySpec& key : object.keys) keys.push_back(&key);
    if (variant != nullptr) {
        for (const KeySpec& key : variant->keys) keys.push_back(&key);
    }
    return keys;
}

const Variant* find_variant(const ObjectSpec& object, std::string_view name) {
    for (const Variant& variant : object.variants) {
        if (variant.name == name) return &variant;
    }
    return nullptr;
}

const KeySpec* find_key(const ObjectSpec& object, const Variant* variant, std::string_view name) {
    for (const KeySpec& key : object.keys) {
        if (key.name == name) return &key;
    }
    if (variant == nullptr) return nullptr;
    for (const KeySpec& key : variant->keys) {
        if (key.name == name) return &key;
    }
    return nullptr;
}

std::string range_words(const Range& range) {
    // A bound of 1e75 is no bound to a reader; who passes it is told by the checker.
    const bool below = range.lower > -kLargestCoordinate;
    const bool above = range.upper < kLargestCoordinate;
    std::string lower = fmt::format("{} {}", range.lower_open ? ">" : ">=", range.lower);
    // 2^64 stands for the largest whole number below it.
    const std::string upper = range.upper == 0x1p64 ? "18446744073709551615" : fmt::format("{}", range.upper);
    if (below && above) return range.lower == range.upper ? upper : fmt::format("{} and <= {}", lower, upper);
    if (below) return lower;
    return above ? "<= " + upper : "";
}

std::string expectation(const KeySpec& key) {
    switch (key.type) {
        case ValueType::number:
            return number_words(key, "a number");
        case ValueType::integer:
            return number_words(key, "a whole number");
        case ValueType::boolean:
            return "true or false";
        case ValueType::text:
            return "a text that is not empty";
        case ValueType::file:
            return "the path of a file";
        case ValueType::choice:
            return choice_words(key);
        case ValueType::integers:
            return "a list of whole numbers, at least one";
        case ValueType::vector:
            return vector_words(key);
        case ValueType::scale:
            return "a number other than 0, or three in [x, y, z]";
        case ValueType::pair:
            return pair_words(key);
        case ValueType::object:
            return fmt::format("an object {{...}} ({})", key.content->title);
        case ValueType::named_object:
            return fmt::format("an object {{...}} ({}), or one of the names in \"{}\"", key.content->title, key.table);
        case ValueType::list:
            return key.not_empty ? "a list [...] of objects, at least one" : "a list [...] of objects";
        case ValueType::list_or_file:
            return "a list [...] of objects, or {\"file\": ...}";
        case ValueType::table:
            return fmt::format("an object {{\"name\": {{...}}}} ({} by name)", key.content->title);
        case ValueType::text_table:
            return "an object {\"name\": \"text\"}";
        case ValueType::quantity:
            return "a number or [x, y, z]";
        case ValueType::vector_pair:
            return "[x, y, z] or [[x, y, z], [spread, spread, spread]], each " + range_words(key.range);
        case ValueType::quantity_table:
            return "an object {\"name\": value}, a value being a number, [mean, spread], [x, y, z] or [[x, y, z], "
                   "[spread, spread, spread]]";
    }
    return "";
}

}  // namespace ricochet::detail
