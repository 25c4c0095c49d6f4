#include "ricochet/io/detail/force_keys.h"

#include <utility>

#include "ricochet/io/detail/key_ranges.h"

namespace ricochet::detail {
namespace {

KeySpec number_key(std::string_view name, std::string_view description, std::string_view unit, Range range,
                   std::string_view fallback = {}) {
    return {.name = name,
            .description = description,
            .unit = unit,
            .range = range,
            .fallback = fallback,
            .required = fallback.empty()};
}

KeySpec vector_key(std::string_view name, std::string_view description, std::string_view unit,
                   std::string_view fallback = {}) {
    return {.name = name,
            .type = ValueType::vector,
            .description = description,
            .unit = unit,
            .range = kCoordinate,
            .fallback = fallback,
            .required = fallback.empty()};
}

KeySpec direction_key(std::string_view name, std::string_view description, std::string_view fallback = {}) {
    KeySpec key = vector_key(name, description, "", fallback);
    key.not_zero = true;
    return key;
}

KeySpec axis_point_key() { return vector_key("point", "A point of the axis.", "m", "[0, 0, 0]"); }

KeySpec axis_key() { return direction_key("axis", "Direction of the axis, of any length; right-hand rule."); }

KeySpec center_key() { return vector_key("center", "Its centre.", "m", "[0, 0, 0]"); }

const ObjectSpec& gust_spec() {
    static const ObjectSpec spec{
        .title = "gust",
        .description = "The wind is multiplied by 1 + amplitude sin(2 pi (frequency t + phase)).",
        .keys = {number_key("amplitude", "Part of the wind's speed; above 1 the wind turns round at times.", "",
                            kNotNegative),
                 number_key("frequency", "How often it rises and falls.", "Hz", kNotNegative),
                 number_key("phase", "Where in its cycle it starts.", "turns", kCoordinate, "0")}};
    return spec;
}

Variant uniform_flow() {
    return {.name = "uniform",
            .description = "A wind: the same velocity everywhere.",
            .keys = {vector_key("velocity", "Velocity.", "m/s"),
                     {.name = "gust",
                      .type = ValueType::object,
                      .description = "Lets it rise and fall: `amplitude` (part of the speed), `frequency` (Hz) and "
                                     "`phase` (turns, 0 unless given).",
                      .without = "steady",
                      .content = &gust_spec()}}};
}

Variant vortex_flow() {
    return {.name = "vortex",
            .description = "A straight vortex without end.",
            .keys = {axis_point_key(),
                     axis_key(),
                     number_key("circulation",
                                "Speed times circumference, outside the core; negative turns the other "
                                "way.",
                                "m^2/s", kCoordinate),
                     number_key("core_radius", "Radius of the core, in which the speed falls to 0 on the axis.", "m",
                                kLength),
                     {.name = "profile",
                      .type = ValueType::choice,
                      .description = "How the speed depends on the distance.",
                      .fallback = "\"rankine\"",
                      .choices = {{"rankine", "the core turns like a rigid body"},
                                  {"lamb_oseen", "smooth, as viscosity spreads a line vortex"}}}}};
}

Variant turbulence_flow() {
    return {.name = "turbulence",
            .description = "Eddies of several sizes without divergence (curl noise).",
            .keys = {number_key("speed", "Root mean square of the speed.", "m/s", kNotNegative),
                     number_key("length", "Size of the largest eddies.", "m", kLength),
                     {.name = "octaves",
                      .type = ValueType::integer,
                      .description = "Sizes of eddies, each half as large as the one before.",
                      .range = {.lower = 1.0, .upper = 16.0},
                      .fallback = "3"},
                     number_key("gain", "Speed of the eddies of a size over that of the size before.", "",
                                {.lower = 0.0, .upper = 1.0, .lower_open = true}, "0.5"),
                     number_key("rate", "How often in a second the largest eddies are replaced by others; 0 is frozen.",
                                "1/s", kNotNegative, "0"),
                     {.name = "seed",
                      .type = ValueType::integer,
                      .description = "Which turbulence; independent of the simulation's seed.",
                      .range = {.lower = 0.0, .upper = 18446744073709551615.0},
                      .fallback = "0"}}};
}

Variant grid_flow() {
    return {.name = "grid",
            .description = "Samples on a regular grid, interpolated linearly along each axis.",
            .keys = {{.name = "file",
                      .type = ValueType::file,
                      .description = "A VTK image (.vti) with point data; not compressed.",
                      .required = true},
                     {.name = "array",
                      .type = ValueType::text,
                      .description = "Name of the array, with three components.",
                      .without = "the first with three components"},
                     {.name = "outside",
                      .type = ValueType::choice,
                      .description = "What holds beyond the grid.",
                      .fallback = "\"clamp\"",
                      .choices = {{"clamp", "the value at the nearest place of the grid"}, {"zero", "nothing"}}}}};
}

std::vector<Variant> plain_flows() {
    return {
        uniform_flow(),
        vortex_flow(),
        {.name = "radial",
         .description = "A source, or a sink, with a soft core.",
         .keys = {center_key(),
                  number_key("strength", "Volume that comes out in a second; negative for a sink.", "m^3/s",
                             kCoordinate),
                  number_key("core_radius", "Radius of the core, in which the speed falls to 0.", "m", kLength)}},
        {.name = "rotation",
         .description = "Turns like a rigid body.",
         .keys = {axis_point_key(), vector_key("angular_velocity", "Along the axis; right-hand rule.", "rad/s")}},
        {.name = "shear",
         .description = "A velocity that grows linearly along a direction.",
         .keys = {vector_key("point", "A point where the fluid is at rest.", "m", "[0, 0, 0]"),
                  vector_key("rate", "Velocity gained per metre.", "1/s"),
                  direction_key("gradient", "Direction along which it grows, of any length.")}},
        turbulence_flow(),
        {.name = "sphere",
         .description = "Flow of an ideal fluid past a ball; nothing moves inside it.",
         .keys = {center_key(),
                  {.name = "radius", .description = "Its radius.", .unit = "m", .range = kLength, .required = true},
                  vector_key("velocity", "Velocity far away from it.", "m/s")}},
        grid_flow(),
    };
}

KeySpec flow_key(std::string_view without) {
    return {.name = "flow",
            .type = ValueType::named_object,
            .description = "How the fluid moves: a flow, or the name of one in `flows`.",
            .without = without,
            .required = without.empty(),
            .content = &flow_spec(),
            .table = "flows"};
}

constexpr std::string_view kAtRest = "at rest";

KeySpec density_key() {
    return number_key("fluid_density", "Density of the fluid; the default is air's at 20 degrees C.", "kg/m^3",
                      kNotNegative, "1.204");
}

KeySpec viscosity_key() {
    return number_key("viscosity", "Dynamic viscosity of the fluid; the default is air's at 20 degrees C.", "Pa s",
                      kPositive, "1.82e-5");
}

Variant quadratic_drag() {
    KeySpec density = density_key();
    density.needs = "drag_coefficient";
    return {.name = "quadratic_drag",
            .description =
                "Drag of fast bodies: F = -c |w| w, or -1/2 rho C_d pi r^2 |w| w by the particle's radius "
                "(none for points); w is the velocity relative to the flow.",
            .keys = {{.name = "coefficient",
                      .description = "The c of F = -c |w| w.",
                      .unit = "kg/m",
                      .range = kNotNegative},
                     {.name = "drag_coefficient",
                      .description = "The C_d, for particles with a radius.",
                      .range = kNotNegative},
                     std::move(density),
                     flow_key(kAtRest)},
            .exactly_one_of = {"coefficient", "drag_coefficient"}};
}

std::vector<Variant> drags() {
    return {
        {.name = "drag",
         .description = "Linear drag F = -c w; w is the velocity relative to the flow.",
         .keys = {number_key("coefficient", "The c of F = -c w.", "kg/s", kNotNegative), flow_key(kAtRest)}},
        quadratic_drag(),
        {.name = "stokes_drag",
         .description = "Drag of slow small spheres: F = -6 pi mu r w by the particle's radius (none for points).",
         .keys = {viscosity_key(), flow_key(kAtRest)}},
        {.name = "schiller_naumann_drag",
         .description = "Drag of spheres at any speed, by the particle's radius (none for points): C_d = 24 / Re "
                        "(1 + 0.15 Re^0.687) below Re = 1000, 0.44 above.",
         .keys = {density_key(), viscosity_key(), flow_key(kAtRest)}},
        {.name = "buoyancy",
         .description = "Lift of the fluid that a particle displaces: F = -rho 4/3 pi r^3 g (none for points).",
         .keys = {number_key("fluid_density", "Density of the fluid.", "kg/m^3", kNotNegative),
                  vector_key("gravity", "The g.", "m/s^2")}},
    };
}

const ObjectSpec& attractor_spec() {
    static const ObjectSpec spec{
        .title = "attractor",
        .description = "A point that attracts.",
        .keys = {vector_key("position", "Where it stands.", "m"),
                 number_key("strength", "Gravitational constant times mass; negative repels.", "m^3/s^2", kCoordinate),
                 number_key("softening", "Length over which it is smeared out.", "m",
                            {.lower = 0.0, .upper = kLargestCoordinate}, "0")}};
    return spec;
}

Variant radial_force() {
    return {.name = "radial",
            .description =
                "Towards a centre by a power of the distance: |F| = strength (s / reference)^exponent with "
                "s^2 = distance^2 + softening^2 (times distance / s).",
            .keys = {center_key(),
                     number_key("strength", "Force at the reference distance; negative pushes away.", "N", kCoordinate),
                     number_key("exponent", "1 for a spring, -2 for Coulomb's law.", "",
                                {.lower = -12.0, .upper = 12.0}, "-2"),
                     number_key("softening", "Length within which it weakens.", "m",
                                {.lower = 0.0, .upper = kLargestCoordinate}, "0"),
                     number_key("reference", "The distance at which the strength is meant.", "m", kLength, "1")}};
}

Variant anchor_force() {
    return {.name = "anchor",
            .description = "A spring and damper to a fixed point; the damper acts along the spring.",
            .keys = {vector_key("position", "The fixed point.", "m"),
                     number_key("stiffness", "Spring constant.", "N/m", kNotNegative),
                     number_key("rest_length", "Length at which it does not pull.", "m",
                                {.lower = 0.0, .upper = kLargestCoordinate}, "0"),
                     number_key("damping", "Force over the speed along the spring.", "kg/s", kNotNegative, "0")}};
}

std::vector<Variant> fields() {
    return {
        {.name = "point_gravity",
         .description = "Gravity of point masses, a = -G M d / (|d|^2 + softening^2)^(3/2).",
         .keys = {{.name = "attractors",
                   .type = ValueType::list,
                   .description = "Objects with `position` (m), `strength` (G M, m^3/s^2) and `softening` (m, 0 unless "
                                  "given).",
                   .required = true,
                   .content = &attractor_spec()}}},
        radial_force(),
        {.name = "swirl",
         .description = "Around an axis: grows linearly within the core, falls as one over the distance outside.",
         .keys = {axis_point_key(), axis_key(),
                  number_key("acceleration", "At the rim of the core; negative turns the other way.", "m/s^2",
                             kCoordinate),
                  number_key("core_radius", "Radius of the core.", "m", kLength)}},
        {.name = "field",
         .description = "The vectors of a flow, taken as accelerations or forces.",
         .keys = {flow_key(""),
                  {.name = "as",
                   .type = ValueType::choice,
                   .description = "What the vectors mean.",
                   .fallback = "\"acceleration\"",
                   .choices = {{"acceleration", "m/s^2, the same for every mass"}, {"force", "N"}}}}},
        {.name = "lorentz",
         .description = "Charged particles in uniform fields: F = q (E + v x B).",
         .keys = {number_key("charge", "Of every particle.", "C", kCoordinate),
                  vector_key("electric", "The E.", "V/m", "[0, 0, 0]"),
                  vector_key("magnetic", "The B.", "T", "[0, 0, 0]")}},
        anchor_force(),
    };
}

std::vector<Variant> all_forces() {
    std::vector<Variant> forces = {{.name = "gravity",
                                    .description = "The same acceleration everywhere.",
                                    .keys = {vector_key("acceleration", "Acceleration.", "m/s^2")}}};
    for (Variant& drag : drags()) forces.push_back(std::move(drag));
    for (Variant& field : fields()) forces.push_back(std::move(field));
    return forces;
}

}  // namespace

const ObjectSpec& flow_spec() {
    static ObjectSpec spec{.title = "flow",
                           .description = "How a fluid moves.",
                           .keys = {number_key("factor", "Multiplies the velocity.", "", kCoordinate, "1")},
                           .variants = plain_flows()};
    // A sum is made of flows, so this part of the table refers to the whole.
    static const bool closed = [] {
        spec.variants.push_back({.name = "sum",
                                 .description = "Several flows at once.",
                                 .keys = {{.name = "parts",
                                           .type = ValueType::list,
                                           .description = "Flows; their velocities add up.",
                                           .required = true,
                                           .content = &spec}}});
        return true;
    }();
    (void)closed;
    return spec;
}

const ObjectSpec& force_spec() {
    static const ObjectSpec spec{.title = "force",
                                 .description = "Forces on particles; they add up.",
                                 .keys = {{.name = "particles",
                                           .type = ValueType::integers,
                                           .description = "Ids of the particles that feel it.",
                                           .without = "all"}},
                                 .variants = all_forces()};
    return spec;
}

}  // namespace ricochet::detail
