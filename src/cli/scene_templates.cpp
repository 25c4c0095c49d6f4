#include "cli/scene_templates.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "ricochet/core/vec3.h"

namespace ricochet::cli {

namespace {

constexpr double kGravity = 9.81;

// Number of frames of every scene.
constexpr int kFrames = 150;

// Number of time steps of a scene with contacts between spheres. In a hopper, spheres overlap by 0.11 radii with 300
// steps and by 0.022 radii with 1200 steps. With 2400 steps they overlap by 0.003 radii, which `--verify` accepts.
constexpr int kContactSteps = 2400;

// Lengths and times of a scene.
struct Fit {
    Vec3 center;    // centre of the mesh
    Vec3 size;      // size of the mesh, in m
    double length;  // diagonal of the mesh, in m
    double spread;  // radius of the mesh about the vertical axis, in m
    double ground;  // height of the ground, in m
    double top;     // top of the mesh, in m
    double fall;    // time of a free fall over the diagonal, in s
    double grid;    // unit to which coordinates are rounded, in m
};

Fit fit_to(const Box3& bounds) {
    Fit fit{};
    fit.center = bounds.center();
    fit.size = bounds.size();
    fit.length = bounds.diagonal();
    fit.spread = 0.5 * std::hypot(fit.size.x, fit.size.y);
    fit.ground = bounds.lower.z;
    fit.top = bounds.upper.z;
    fit.fall = std::sqrt(2.0 * fit.length / kGravity);
    fit.grid = std::pow(10.0, std::floor(std::log10(fit.length)) - 4.0);
    return fit;
}

// Formats a size, rate or time with two significant digits, so that users can easily change it.
std::string about(double value) { return fmt::format("{:.2g}", value); }
// Formats an integer with two significant digits.
std::string whole(double value) {
    const double unit = std::pow(10.0, std::max(0.0, std::floor(std::log10(value)) - 1.0));
    return fmt::format("{:.0f}", std::round(value / unit) * unit);
}
// Formats a coordinate, rounded to 1/10000 of the mesh's size.
std::string at(double value, const Fit& fit) {
    const double rounded = std::round(value / fit.grid) * fit.grid;
    return fmt::format("{:.12g}", rounded == 0.0 ? 0.0 : rounded);
}
std::string at(const Vec3& p, const Fit& fit) {
    return fmt::format("[{}, {}, {}]", at(p.x, fit), at(p.y, fit), at(p.z, fit));
}
Vec3 above_mesh(const Fit& fit, double height) { return {fit.center.x, fit.center.y, fit.top + height * fit.length}; }

struct Part {
    std::string title;       // description, as one line of comment
    std::string picture{};   // members of the scene's `picture`
    std::string contacts{};  // members of the scene's `particle_contacts`
    std::string emitters;    // contents of the list
    std::string surface;     // the mesh's material
    double duration;         // s
    int steps = 300;         // time steps in the duration, a multiple of kFrames
    double height;           // height above the mesh that the picture and the bounds include, relative to the mesh's
                             // diagonal
    bool has_box = false;    // a box around the mesh
    bool has_gravity = true;
};

// Returns the edge lengths of a box around the mesh.
Vec3 box_size(const Fit& fit) {
    const double edge = 0.5 * fit.length;
    return fit.size + Vec3{edge, edge, edge};
}

// Opacity over the lifetime of spray and sparks, which fade out.
constexpr const char* kFade =
    R"("over_life": {"opacity": {"keys": [{"time": 0, "value": 1}, {"time": 0.6, "value": 0.8}, {"time": 1, "value": 0}]}})";

Part rain(const Fit& fit) {
    const std::string size = about(0.006 * fit.length);
    return {.title = "Rain: drops fall on the mesh, splash where they hit, and fade.",
            .picture = R"("particles": "soft")",
            .emitters = fmt::format(
                R"(    // Drops start on a disk above the mesh. "rate" is their number per second.
    {{"name": "cloud", "type": "disk", "center": {}, "normal": [0, 0, -1], "radius": {}, "rate": {},
     "speed": [{}, {}], "lifetime": [{}, {}], "mass": 1e-4, "particle_size": {}, "color": [0.1, 0.32, 0.75],
     "opacity": 0.9, {}}},
    // Every drop that hits throws up two smaller ones.
    {{"name": "splash", "type": "child", "parent": "cloud", "on": "impact", "threshold_impulse": {}, "share": false,
     "count": 2, "speed": [{}, {}], "direction": [0, 0, 1], "cone": 60, "inherit_velocity": 0.2, "mass": 1e-5,
     "lifetime": [{}, {}], "particle_size": {}, "color": [0.6, 0.78, 1], "opacity": 0.8,
     {}}})",
                at(above_mesh(fit, 0.8), fit), about(1.1 * fit.spread + 0.1 * fit.length), whole(3000.0 / fit.fall),
                about(0.5 * fit.length / fit.fall), about(0.1 * fit.length / fit.fall), about(2.0 * fit.fall),
                about(0.3 * fit.fall), size, kFade, about(1e-4 * fit.length / fit.fall),
                about(0.6 * fit.length / fit.fall), about(0.25 * fit.length / fit.fall), about(0.5 * fit.fall),
                about(0.2 * fit.fall), about(0.0035 * fit.length), kFade),
            .surface = R"({"restitution": 0.1, "friction": 0.1})",
            .duration = 5.0 * fit.fall,
            .height = 0.35};
}

Part debris(const Fit& fit) {
    std::string emitters =
        "    // Spheres of three sizes: they roll, and most come to rest. Pairs are [mean, spread].\n";
    struct Kind {
        const char* name;
        double radius;
        double count;
        const char* color;
    };
    constexpr std::array<Kind, 3> kKinds = {{{"gravel", 0.006, 1800, "[[0.2, 0.16, 0.12], [0.06, 0.05, 0.04]]"},
                                             {"stones", 0.012, 500, "[[0.26, 0.12, 0.06], [0.05, 0.03, 0.02]]"},
                                             {"boulders", 0.024, 90, "[[0.11, 0.12, 0.14], [0.03, 0.03, 0.03]]"}}};
    double height = 0.45;
    for (const Kind& kind : kKinds) {
        emitters += fmt::format(
            R"(    {{"name": "{}", "type": "disk", "center": {}, "normal": [0, 0, -1], "radius": {}, "rate": {}, "stop": {},
     "speed": [{}, {}], "particle_radius": [{}, {}], "color": {}}}{})",
            kind.name, at(above_mesh(fit, height), fit), about(0.7 * fit.spread + 0.05 * fit.length),
            whole(kind.count / (3.0 * fit.fall)), about(3.0 * fit.fall), about(0.3 * fit.length / fit.fall),
            about(0.2 * fit.length / fit.fall), about(kind.radius * fit.length), about(0.3 * kind.radius * fit.length),
            kind.color, kind.radius < 0.02 ? ",\n" : "");
        height += 0.1;
    }
    return {.title = "Debris: gravel, stones and boulders fall on the mesh, roll off it, and most come to rest.",
            .contacts = R"("restitution": 0.3, "friction": 0.4)",
            .emitters = emitters,
            .surface = R"({"restitution": 0.3, "friction": 0.4, "rolling_friction": 0.08})",
            .duration = 6.0 * fit.fall,
            .steps = kContactSteps,
            .height = 0.35};
}

Part sparks(const Fit& fit) {
    const double speed = 1.6 * fit.length / fit.fall;
    const Vec3 place =
        above_mesh(fit, 0.05) + Vec3{-0.65 * fit.spread - 0.15 * fit.length, -0.2 * fit.length, 0.15 * fit.length};
    const Vec3 aim = Vec3{fit.center.x, fit.center.y, fit.center.z + 0.2 * fit.size.z} - place;
    const std::string size = about(0.003 * fit.length);
    return {.title = "Sparks: a grinding wheel's spray hits the mesh, bounces off and cools from white to red.",
            .picture = R"("particles": "glow", "light": "night")",
            .emitters = fmt::format(
                R"(    // A nozzle beside the mesh, aimed at it. "cone" is the half angle of the spray in degrees.
    {{"name": "wheel", "type": "point", "center": {}, "direction": {}, "cone": 24, "rate": {}, "speed": [{}, {}],
     "lifetime": [{}, {}], "mass": 1e-6, "particle_size": [{}, {}], "color": [1, 0.85, 0.55], "opacity": 0.9,
     "over_life": {{"opacity": {{"keys": [{{"time": 0, "value": 1}}, {{"time": 0.7, "value": 0.7}}, {{"time": 1, "value": 0}}]}},
                   "color": {{"keys": [{{"time": 0, "value": [1, 1, 1]}}, {{"time": 0.5, "value": [1, 0.6, 0.3]}},
                                      {{"time": 1, "value": [0.8, 0.2, 0.1]}}]}}}}}})",
                at(place, fit), at(aim, fit), whole(4000.0 / fit.fall), about(speed), about(0.35 * speed),
                about(1.6 * fit.fall), about(0.8 * fit.fall), size, about(0.001 * fit.length)),
            .surface = R"({"restitution": 0.55, "friction": 0.2})",
            .duration = 4.0 * fit.fall,
            .height = 0.3};
}

Part fountain(const Fit& fit) {
    const double speed = 1.45 * fit.length / fit.fall;
    const double time = speed / kGravity;
    return {.title = "Fountain: a jet rises from above the mesh, falls back on it and runs off.",
            .picture = R"("particles": "soft")",
            .emitters = fmt::format(
                R"(    // The jet: a narrow cone that stands on its tip just above the mesh.
    {{"name": "jet", "type": "cone", "apex": {}, "axis": [0, 0, 1], "angle": 8, "height": {}, "rate": {},
     "speed": [{}, {}], "lifetime": [{}, {}], "mass": 1e-4, "particle_size": [{}, {}],
     "color": [[0.35, 0.65, 0.95], [0.08, 0.06, 0.05]], "opacity": 0.8,
     {}}},
    // Drops that hit throw up smaller ones.
    {{"name": "splash", "type": "child", "parent": "jet", "on": "impact", "threshold_impulse": {}, "share": false,
     "count": [1.5, 1], "speed": [{}, {}], "direction": [0, 0, 1], "cone": 55, "inherit_velocity": 0.25, "mass": 1e-5,
     "lifetime": [{}, {}], "particle_size": {}, "color": [0.65, 0.82, 1], "opacity": 0.7,
     {}}})",
                at(above_mesh(fit, 0.01), fit), about(0.03 * fit.length), whole(4000.0 / fit.fall), about(speed),
                about(0.08 * speed), about(2.0 * time + 1.2 * fit.fall), about(0.3 * fit.fall),
                about(0.006 * fit.length), about(0.002 * fit.length), kFade, about(5e-5 * speed), about(0.3 * speed),
                about(0.1 * speed), about(0.5 * fit.fall), about(0.2 * fit.fall), about(0.0035 * fit.length), kFade),
            .surface = R"({"restitution": 0.15, "friction": 0.1})",
            .duration = 6.0 * fit.fall,
            .height = 0.55};
}

Part gas(const Fit& fit, bool closed) {
    const double speed = 0.4 * fit.length / fit.fall;
    const std::string common = fmt::format(R"("burst": 20000, "speed": [{}, {}], "particle_size": {}}})", about(speed),
                                           about(0.6 * speed), about(0.0035 * fit.length));
    std::string emitters;
    if (closed) {
        emitters =
            R"(    // Molecules fill the inside of the closed mesh, launched in every direction.
    {"name": "gas", "type": "mesh", "collider": "mesh", "volume": true, )" +
            common;
    } else {
        emitters = fmt::format(
            R"(    // The mesh has no closed interior, so the gas fills a box around it.
    {{"name": "gas", "type": "sphere", "center": {}, "radius": {}, {})",
            at(above_mesh(fit, 0.12), fit), about(0.08 * fit.length), common);
    }
    return {.title = closed ? "Gas: test molecules inside the closed mesh, with elastic reflections and no forces."
                            : "Gas: test molecules around the mesh in a closed box, with elastic reflections.",
            .emitters = emitters,
            .surface = R"({"restitution": 1})",
            .duration = 6.0 * fit.fall,
            .height = 0.0,
            .has_box = !closed,
            .has_gravity = false};
}

Part part_of(SceneTemplate kind, const Fit& fit, bool closed) {
    switch (kind) {
        case SceneTemplate::rain:
            return rain(fit);
        case SceneTemplate::debris:
            return debris(fit);
        case SceneTemplate::sparks:
            return sparks(fit);
        case SceneTemplate::fountain:
            return fountain(fit);
        case SceneTemplate::gas:
            return gas(fit, closed);
    }
    return rain(fit);
}

// Makes the container transparent, because an opaque container would hide the gas.
constexpr const char* kGlass = R"(, "looks": {"glass": true})";

std::string colliders_text(const FittedMesh& mesh, const Fit& fit, const Part& part) {
    std::string placement = mesh.up.empty() || mesh.up == mesh.format_up ? "" : fmt::format(R"(, "up": "{}")", mesh.up);
    if (mesh.scale > 0.0) placement += fmt::format(R"(, "scale": {})", mesh.scale);
    std::string text =
        fmt::format(R"(    {{"name": "mesh", "type": "mesh", "file": {}, "material": "surface"{}{}}})",
                    nlohmann::json(mesh.file).dump(), placement, part.has_gravity || part.has_box ? "" : kGlass);
    if (part.has_gravity) {
        text += fmt::format(
            ",\n    {{\"name\": \"ground\", \"type\": \"plane\", \"point\": {}, \"normal\": [0, 0, 1], \"material\": "
            "\"ground\"}}",
            at({fit.center.x, fit.center.y, fit.ground}, fit));
    } else if (part.has_box) {
        text += fmt::format(
            ",\n    {{\"name\": \"box\", \"type\": \"box\", \"size\": {}, \"position\": {}, \"material\": "
            "\"surface\"{}}}",
            at(box_size(fit), fit), at(fit.center, fit), kGlass);
    }
    return text;
}

// The camera looks from the front, slightly from the right and above. It is far enough away to see the mesh and its
// surroundings.
std::string camera_text(const Fit& fit, const Part& part) {
    constexpr double kFieldOfView = 32.0;
    constexpr double kHalfAngle = 0.5 * kFieldOfView * 3.14159265358979323846 / 180.0;
    const double extra = part.height * fit.length;
    const Vec3 target{fit.center.x, fit.center.y, fit.center.z + 0.35 * extra};
    // The view must contain the corners of a box. It therefore contains the circumscribed sphere of the box.
    const double reach = part.has_box ? 0.5 * length(box_size(fit)) : (0.5 * fit.length + 0.35 * extra) * 0.95;
    const double distance = reach / std::sin(kHalfAngle);
    const Vec3 direction = normalized(Vec3{0.45, -0.8, 0.38});
    return fmt::format(R"({{"position": {}, "target": {}, "field_of_view": {:.0f}}})",
                       at(target + distance * direction, fit), at(target, fit), kFieldOfView);
}

}  // namespace

std::optional<SceneTemplate> template_named(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, SceneTemplate>, 5> kNames = {
        {{"rain", SceneTemplate::rain},
         {"debris", SceneTemplate::debris},
         {"sparks", SceneTemplate::sparks},
         {"gas", SceneTemplate::gas},
         {"fountain", SceneTemplate::fountain}}};
    for (const auto& [known, kind] : kNames) {
        if (known == name) return kind;
    }
    return std::nullopt;
}

std::string scene_text(SceneTemplate kind, const FittedMesh& mesh) {
    const Fit fit = fit_to(mesh.bounds);
    const Part part = part_of(kind, fit, mesh.closed);
    const double step = part.duration / part.steps;
    const Vec3 margin = Vec3{4.0, 4.0, 4.0} * fit.length;
    const std::string picture = part.picture.empty() ? "" : fmt::format("\n  \"picture\": {{{}}},", part.picture);
    const std::string contacts =
        part.contacts.empty()
            ? ""
            : fmt::format(
                  "\n  // Contact between the spheres. Without this line they pass through each other.\n"
                  "  \"particle_contacts\": {{{}}},",
                  part.contacts);
    return fmt::format(
        R"(// {}
//
//     ricochet run SCENE --output DIR
//     ricochet render DIR --output picture.png    (film.mp4 for a film)
//
// Metres, seconds and kilograms; z points up. docs/scene-format.md describes every key.
{{
  "ricochet": 1,
  // {} steps and {} frames. A film lasts as long as the run, unless render --speed changes that.
  "simulation": {{"time_step": {}, "duration": {}, "integrator": "ballistic", "response": "exact", "seed": 1}},
  "forces": [{}],{}
  "materials": {{
    // "restitution": rebound speed divided by approach speed, 0 to 1.
    "surface": {}{}
  }},
  "colliders": [
{}
  ],
  "emitters": [
{}
  ],
  // Particles that leave this box are removed.
  "bounds": {{"lower": {}, "upper": {}}},
  "output": {{"format": "vtp", "every": {}}},{}
  "camera": {}
}}
)",
        part.title, part.steps, kFrames, fmt::format("{:.3g}", step),
        fmt::format("{:.6g}", part.steps * std::stod(fmt::format("{:.3g}", step))),
        part.has_gravity ? R"({"type": "gravity", "acceleration": [0, 0, -9.81]})" : "", contacts, part.surface,
        part.has_gravity ? fmt::format(",\n    \"ground\": {}", part.surface) : "", colliders_text(mesh, fit, part),
        part.emitters, at(mesh.bounds.lower - margin, fit), at(mesh.bounds.upper + margin, fit), part.steps / kFrames,
        picture, camera_text(fit, part));
}

}  // namespace ricochet::cli
