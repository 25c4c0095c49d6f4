#include "cli/render_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

#include <optional>

#include "cli/arguments.h"
#include "ricochet/core/error.h"

namespace ricochet::cli {
namespace {

[[noreturn]] void refuse(const std::string& message) { throw InputError(message); }

std::optional<Camera> parse_camera(const std::string& text) {
    if (text.empty()) return std::nullopt;
    const std::vector<double> v = parse_number_list("--camera", text);
    if (v.size() != 6 && v.size() != 7) {
        refuse(fmt::format("--camera {}: expected px,py,pz,tx,ty,tz[,fov] (position, target, degrees)", text));
    }
    Camera camera;
    camera.position = {v[0], v[1], v[2]};
    camera.target = {v[3], v[4], v[5]};
    if (v.size() == 7) camera.fov_degrees = v[6];
    if (camera.position == camera.target) refuse(fmt::format("--camera {}: position and target are the same", text));
    if (camera.fov_degrees < 1.0 || camera.fov_degrees > 170.0) {
        refuse(fmt::format("--camera {}: the field of view must be from 1 to 170 degrees", text));
    }
    return camera;
}

std::optional<Vec3> parse_up(const std::string& text) {
    if (text.empty()) return std::nullopt;
    if (text == "x") return Vec3{1, 0, 0};
    if (text == "y") return Vec3{0, 1, 0};
    if (text == "z") return Vec3{0, 0, 1};
    refuse(fmt::format("--up {}: expected x, y or z", text));
}

std::optional<Lens> parse_lens(const std::string& text) {
    if (text.empty()) return std::nullopt;
    const std::vector<double> v = parse_number_list("--lens", text);
    if (v.empty() || v.size() > 2 || v[0] < 0.0 || (v.size() == 2 && !(v[1] > 0.0))) {
        refuse(
            fmt::format("--lens {}: expected diameter[,distance] in m (diameter 0: everything is in focus; default "
                        "distance: the target)",
                        text));
    }
    return Lens{v[0], v.size() == 2 ? v[1] : 0.0};
}

std::optional<ValueRange> parse_range(const char* option, const std::string& text) {
    if (text.empty()) return std::nullopt;
    const std::vector<double> v = parse_number_list(option, text);
    if (v.size() != 2 || !(v[0] < v[1])) refuse(fmt::format("{} {}: expected low,high with low < high", option, text));
    return ValueRange{v[0], v[1]};
}

std::optional<ColliderQuantity> parse_collider_color(const std::string& text) {
    if (text == "plain") return std::nullopt;
    if (const auto quantity = collider_quantity_from(text)) return quantity;
    refuse(fmt::format(
        "--collider-color {}: expected plain or hits, impulse, energy, each alone or with /area, /time or /area/time",
        text));
}

ColorMap parse_color_map(const std::string& text) {
    if (const auto map = color_map_from_name(text)) return *map;
    refuse(fmt::format("--color-map {}: expected one of {}", text, fmt::join(color_map_names(), ", ")));
}

ParticleDrawing parse_drawing(const std::string& text) {
    if (const auto drawing = drawing_from_name(text)) return *drawing;
    refuse(fmt::format("--draw {}: expected auto, spheres, streaks, soft, glow, sprites or meshes", text));
}

// Sets the file of a sprite or mesh, and the matching drawing. Throws InputError if the user chose another drawing,
// because that drawing would not use the file.
void choose_file(const char* option, const std::string& file, ParticleDrawing drawing, std::filesystem::path& target,
                 PictureStyle& style) {
    if (file.empty()) return;
    if (style.drawing == ParticleDrawing::automatic) style.drawing = drawing;
    if (style.drawing != drawing) {
        refuse(fmt::format("{} {}: found beside another --draw, expected --draw {}", option, file,
                           drawing == ParticleDrawing::sprites ? "sprites" : "meshes"));
    }
    target = file;
}

std::optional<Lighting> parse_light(const std::string& text) {
    if (text.empty()) return std::nullopt;
    if (const auto lighting = lighting_from_name(text)) return lighting;
    refuse(fmt::format("--light {}: expected one of {}", text, fmt::join(lighting_names(), ", ")));
}

std::optional<Background> parse_background(const std::string& text) {
    if (text.empty()) return std::nullopt;
    if (text == "sky") return Background{};
    if (text == "transparent") return Background{std::nullopt, true};
    constexpr const char* kExpected = "expected sky, transparent, or red,green,blue from 0 to 1";
    if (text.find(',') == std::string::npos) refuse(fmt::format("--background {}: {}", text, kExpected));
    const std::vector<double> v = parse_number_list("--background", text);
    const auto is_good = [](double x) { return x >= 0.0 && x <= 1.0; };
    if (v.size() != 3 || !is_good(v[0]) || !is_good(v[1]) || !is_good(v[2])) {
        refuse(fmt::format("--background {}: {}", text, kExpected));
    }
    return Background{Vec3{v[0], v[1], v[2]}, false};
}

std::optional<Ground> parse_ground(const std::string& text) {
    if (text.empty()) return std::nullopt;
    if (text == "none") return Ground{Ground::Kind::none, 0.0};
    if (text == "auto") return Ground{Ground::Kind::automatic, 0.0};
    const std::optional<double> height = parse_number(text);
    if (!height) refuse(fmt::format("--ground {}: expected none, auto, or a height in m (a number alone)", text));
    return Ground{Ground::Kind::at_height, *height};
}

}  // namespace

PictureStyle picture_style(const RenderArguments& arguments) {
    PictureStyle style;
    style.color_by = arguments.color_by;
    style.drawing = parse_drawing(arguments.drawing);
    choose_file("--sprite", arguments.sprite, ParticleDrawing::sprites, style.sprite, style);
    choose_file("--mesh", arguments.mesh, ParticleDrawing::meshes, style.mesh, style);
    if (arguments.black_body != 0.0) style.black_body = arguments.black_body;
    style.range = parse_range("--range", arguments.range);
    style.map = parse_color_map(arguments.color_map);
    style.particle_radius = arguments.particle_radius;
    style.collider_quantity = parse_collider_color(arguments.collider_color);
    style.collider_range = parse_range("--collider-range", arguments.collider_range);
    for (const std::string& name : arguments.hidden) {
        if (std::find(arguments.glass.begin(), arguments.glass.end(), name) != arguments.glass.end())
            refuse(fmt::format("--glass {0}: found beside --hide {0}, expected one of them", name));
    }
    style.hidden = arguments.hidden;
    style.glass = arguments.glass;
    style.camera = parse_camera(arguments.camera);
    style.up = parse_up(arguments.up);
    style.lens = parse_lens(arguments.lens);
    if (arguments.night && !arguments.light.empty()) refuse("--night: found beside --light, expected one of them");
    style.light = parse_light(arguments.night ? "night" : arguments.light);
    style.background = parse_background(arguments.background);
    style.ground = parse_ground(arguments.ground);
    if (arguments.shutter >= 0.0) style.shutter = arguments.shutter;
    return style;
}

void check_numbers(const RenderArguments& arguments) {
    const auto in_range = [](const char* option, double value, double low, double high) {
        if (!(value >= low && value <= high)) refuse(fmt::format("{} {}: expected {} to {}", option, value, low, high));
    };
    in_range("--samples", rays_a_pixel(arguments), 1, 4096);
    const char* const finer = arguments.samples         ? "--samples"
                              : arguments.no_filter     ? "--no-filter"
                              : !arguments.lens.empty() ? "--lens"
                                                        : nullptr;
    if (arguments.preview && finer != nullptr) {
        refuse(fmt::format(
            "{}: found beside --preview, which has one ray a pixel, no noise and no blur, expected one of them",
            finer));
    }
    in_range("--fps", film_rate(arguments), 1, 240);
    in_range("--exposure", arguments.exposure, 0.01, 100);
    in_range("--speed", film_speed(arguments), 1e-6, 1e6);
    if (arguments.shutter != RenderArguments{}.shutter) in_range("--shutter", arguments.shutter, 0, 1e6);
    if (arguments.black_body != 0.0) in_range("--black-body", arguments.black_body, 500, 20000);
    in_range("--particle-radius", arguments.particle_radius.value_or(0.0), 0, 1e15);
}

int rays_a_pixel(const RenderArguments& arguments) { return arguments.samples.value_or(16); }

int film_rate(const RenderArguments& arguments) { return arguments.frames_per_second.value_or(30); }

double film_speed(const RenderArguments& arguments) { return arguments.speed.value_or(1.0); }

void check_film_options(const RenderArguments& arguments, bool film) {
    const char* const given = arguments.frames_per_second ? "--fps" : arguments.speed ? "--speed" : nullptr;
    if (film || given == nullptr) return;
    refuse(fmt::format("{}: found with the picture {}, expected a film (--output with a .mp4 name)", given,
                       arguments.output));
}

void add_render_options(cli::Command command, RenderArguments& a) {
    command.add_option("DIR", a.folder, "Output folder of a run").required();
    command.add_option("--output", a.output, "Picture (.png) or film (.mp4, needs ffmpeg)").required();
    command.add_option("--frame", a.frame,
                       "Step number, last, or all (numbered pictures; default: the scene's, or last)");
    command.add_option("--size", a.size, "WIDTHxHEIGHT in pixels").show_default();
    command.add_option("--camera", a.camera, "px,py,pz,tx,ty,tz[,fov]: position, target, vertical degrees");
    command.add_option("--up", a.up, "Axis that points up: x, y or z (default: against gravity)");
    command.add_option("--lens", a.lens, "diameter[,distance] of a lens and of its plane of focus, in m");
    command.add_option("--color-by", a.color_by,
                       "Array of the frames that colours the particles (default: their own color, or speed)");
    command
        .add_option("--draw", a.drawing,
                    "Particles as spheres, streaks along their path, soft discs by opacity, additive glow, sprites or "
                    "meshes (auto: soft if they have an opacity)")
        .show_default();
    command.add_option("--sprite", a.sprite, "PNG file to draw particles with, facing the camera");
    command.add_option(
        "--black-body", a.black_body,
        "Makes particles glow by their array temperature; value: K of a particle as bright as a sunlit white surface");
    command.add_option("--mesh", a.mesh, "Mesh file to draw particles with, rotated by their spin");
    command.add_option("--light", a.light, "day, noon, overcast, night or studio (default: the scene's, or day)");
    command.add_flag("--night", a.night, "The same as --light night");
    command.add_option("--background", a.background, "sky, transparent (.png), or red,green,blue from 0 to 1");
    command.add_option("--ground", a.ground, "none, auto (below everything), or the height of a ground, m");
    command.add_option("--color-map", a.color_map, "viridis, plasma, inferno, magma or turbo").show_default();
    command.add_option("--range", a.range, "low,high of the colours (default: from the frames)");
    command
        .add_option("--collider-color", a.collider_color,
                    "plain, or hits, impulse or energy of each triangle, followed by /area, /time, both or nothing")
        .show_default();
    command.add_option("--collider-range", a.collider_range,
                       "low,high of the collider colours (default: from the run)");
    command.add_flag("--color-bar", a.color_bar, "Draw colour bars with unit and range");
    command.add_option("--hide", a.hidden, "Leave out the collider of this name (repeatable)").one_value_each();
    command.add_option("--glass", a.glass, "See through the collider of this name (repeatable)").one_value_each();
    command.add_option("--particle-radius", a.particle_radius,
                       "Radius drawn, m (default: the scene's; 0: the particles' own)");
    command.add_option("--samples", a.samples, "Rays per pixel (default: 16)");
    command.add_flag("--preview", a.preview,
                     "Draft: one ray per pixel, hard shadows, no light between surfaces, no blur");
    command.add_flag("--no-filter", a.no_filter, "Do not remove the noise of few samples");
    command.add_option("--exposure", a.exposure, "Brightness factor").show_default();
    command.add_option("--shutter", a.shutter, "Exposure time in seconds of the run; moving objects blur");
    command.add_option("--fps", a.frames_per_second, "Pictures per second of a film (default: 30)");
    command.add_option("--speed", a.speed, "Seconds of the run in a second of a film (default: 1)");
    command.add_option("--threads", a.threads, "Worker threads (default: all)");
    add_progress_options(command, a.progress, a.quiet);
}

}  // namespace ricochet::cli
