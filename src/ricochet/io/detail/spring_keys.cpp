#include "ricochet/io/detail/spring_keys.h"

#include <utility>

#include "ricochet/io/detail/key_ranges.h"

namespace ricochet::detail {
namespace {

constexpr Range kStiffness{.lower = 0.0, .upper = kLargestCoordinate};

using Keys = std::vector<KeySpec>;

Keys joined(std::initializer_list<Keys> parts) {
    Keys keys;
    for (const Keys& part : parts) keys.insert(keys.end(), part.begin(), part.end());
    return keys;
}

KeySpec damping_key() {
    return {.name = "damping",
            .description = "Force against the rate at which a spring changes its length, over that rate.",
            .unit = "N s/m",
            .range = kStiffness,
            .fallback = "0"};
}

KeySpec breaking_key() {
    return {.name = "breaking_stretch",
            .description = "Stretch, as a part of the rest length, beyond which a spring breaks for good.",
            .range = kPositive,
            .without = "it never breaks"};
}

KeySpec radius_key() {
    return {.name = "radius",
            .description = "Radius of its particles.",
            .unit = "m",
            .range = kNotNegative,
            .fallback = "0"};
}

KeySpec point_key(std::string_view name, std::string_view description) {
    return {.name = name,
            .type = ValueType::vector,
            .description = description,
            .unit = "m",
            .range = kCoordinate,
            .required = true};
}

KeySpec count_key(std::string_view name, std::string_view description, double lower) {
    return {.name = name,
            .type = ValueType::integer,
            .description = description,
            .range = {.lower = lower, .upper = 1e8},
            .required = true};
}

KeySpec particle_key(std::string_view name, std::string_view description) {
    return {.name = name, .type = ValueType::integer, .description = description, .range = kCount, .required = true};
}

const ObjectSpec& spring_spec() {
    static const ObjectSpec spec{.title = "spring",
                                 .description = "A spring between two particles.",
                                 .keys = {particle_key("first", "Number of the particle at one end."),
                                          particle_key("second", "Number of the particle at the other end."),
                                          {.name = "rest_length",
                                           .description = "Length at which it neither pulls nor pushes.",
                                           .unit = "m",
                                           .range = {.lower = 0.0, .upper = kLargestCoordinate},
                                           .without = "the distance of its ends at the start"},
                                          {.name = "stiffness",
                                           .description = "Force over stretch.",
                                           .unit = "N/m",
                                           .range = kStiffness,
                                           .required = true},
                                          damping_key(),
                                          breaking_key()}};
    return spec;
}

const ObjectSpec& pin_box_spec() {
    static const ObjectSpec spec{.title = "pin box",
                                 .description = "A box along the axes; vertices in it, or on its surface, are pinned.",
                                 .keys = {point_key("lower", "Its corner with the smallest coordinates."),
                                          point_key("upper", "Its corner with the largest coordinates.")}};
    return spec;
}

Variant list_variant() {
    return {.name = "list",
            .description =
                "Springs one by one, between particles by their numbers from 0: first those of `particles`, "
                "then those of the ropes, chains, cloths and sheets, each in its order.",
            .keys = {{.name = "springs",
                      .type = ValueType::list,
                      .description = "The springs.",
                      .required = true,
                      .content = &spring_spec()}}};
}

Keys rope_ends() {
    return {point_key("from", "Place of its first particle."), point_key("to", "Place of its last particle.")};
}

// What ropes and chains have in common.
Keys rope_keys() {
    return {{.name = "mass", .description = "Its whole mass.", .unit = "kg", .range = kPositive, .required = true},
            radius_key(),
            {.name = "stiffness", .description = "Of every segment.", .unit = "N/m", .range = kStiffness},
            {.name = "axial_stiffness",
             .description = "Of the material, E A: a segment's stiffness is this over its length at rest.",
             .unit = "N",
             .range = kStiffness},
            damping_key(),
            breaking_key(),
            {.name = "sag",
             .type = ValueType::vector,
             .description = "Direction in which it hangs at first where it is longer than the distance of its ends.",
             .range = kCoordinate,
             .without = "with the uniform forces, or -z",
             .not_zero = true},
            {.name = "pinned",
             .type = ValueType::choice,
             .description = "Which ends never move.",
             .fallback = "\"none\"",
             .choices = {{"none", "both are free"},
                         {"from", "the first particle"},
                         {"to", "the last particle"},
                         {"both", "the first and the last particle"}}}};
}

Variant rope_variant() {
    return {.name = "rope",
            .description = "Particles at equal distances along a line, with springs between neighbours.",
            .keys = joined({rope_ends(),
                            {count_key("nodes", "Its particles.", 2.0),
                             {.name = "length",
                              .description = "Length at rest. A longer rope than the distance of its ends starts as a "
                                             "catenary, a shorter one straight and under tension.",
                              .unit = "m",
                              .range = kLength,
                              .without = "the distance of its ends"}},
                            rope_keys()}),
            .exactly_one_of = {"stiffness", "axial_stiffness"}};
}

Variant chain_variant() {
    return {.name = "chain",
            .description = "A rope by its links; one longer than the distance of its ends starts as a catenary.",
            .keys = joined({rope_ends(),
                            {count_key("links", "Springs in a row; it has one particle more.", 1.0),
                             {.name = "link_length",
                              .description = "Length of a link at rest.",
                              .unit = "m",
                              .range = kLength,
                              .required = true}},
                            rope_keys()}),
            .exactly_one_of = {"stiffness", "axial_stiffness"}};
}

// What cloth has in common, whatever its mesh comes from.
Keys cloth_keys() {
    return {{.name = "mass", .description = "Its whole mass.", .unit = "kg", .range = kPositive},
            {.name = "mass_per_area", .description = "Mass over area.", .unit = "kg/m^2", .range = kPositive},
            radius_key(),
            {.name = "stiffness",
             .description = "Of the springs along the edges.",
             .unit = "N/m",
             .range = kStiffness,
             .required = true},
            {.name = "bending_stiffness",
             .description = "Of springs that join the corners across every edge between two triangles, and so resist "
                            "bending.",
             .unit = "N/m",
             .range = kStiffness,
             .fallback = "0"},
            damping_key(),
            breaking_key(),
            {.name = "pinned",
             .type = ValueType::integers,
             .description = "Numbers, from 0, of vertices that never move.",
             .without = "none"},
            {.name = "pin_boxes",
             .type = ValueType::list,
             .description = "Boxes in which vertices never move.",
             .fallback = "[]",
             .content = &pin_box_spec()}};
}

Variant cloth_variant() {
    return {.name = "cloth",
            .description =
                "A particle at every vertex of a mesh, a spring along every edge; at rest as the mesh is. A "
                "particle has a third of the mass of every triangle around it.",
            .keys = joined({{{.name = "file",
                              .type = ValueType::file,
                              .description = "The mesh: OBJ, PLY, STL or OFF.",
                              .required = true}},
                            placement_keys(""),
                            cloth_keys()}),
            .exactly_one_of = {"mass", "mass_per_area"}};
}

Variant sheet_variant() {
    return {.name = "sheet",
            .description =
                "A cloth without a file: a flat sheet of cells of two triangles each. Vertex (i, j) has the "
                "number j (cells_u + 1) + i.",
            .keys = joined({{point_key("corner", "One of its corners."),
                             point_key("side_u", "From there along one side to its end."),
                             point_key("side_v", "From there along the other side."),
                             count_key("cells_u", "Cells along the one side.", 1.0),
                             count_key("cells_v", "Cells along the other side.", 1.0)},
                            cloth_keys()}),
            .exactly_one_of = {"mass", "mass_per_area"}};
}

}  // namespace

const ObjectSpec& springs_spec() {
    static const ObjectSpec spec{
        .title = "springs",
        .description =
            "Springs between particles, and things made of them: ropes, chains and cloth bring their own "
            "particles. docs/springs.md says how they pull and which integrator they need.",
        .keys = {},
        .variants = {list_variant(), rope_variant(), chain_variant(), cloth_variant(), sheet_variant()}};
    return spec;
}

}  // namespace ricochet::detail
