#include "cli/commands.h"

#include <fmt/format.h>

#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/run_pictures.h"
#include "cli/terminal.h"
#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"
#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

using namespace cli;

// The arguments as they stand on the command line.
struct RenderArguments {
    std::string folder;
    std::string output;
    std::string frame = "last";
    std::string size = "1280x720";
    std::string camera;
    std::string up;
    std::string color_by;
    std::string drawing = "auto";
    std::string color_map = "plasma";
    std::string range;
    std::string collider_color = "plain";
    std::vector<std::string> hidden;
    std::vector<std::string> glass;
    double particle_radius = 0.0;
    int samples = 16;
    int frames_per_second = 30;
    double exposure = 1.0;
    bool night = false;
    std::string threads;
    std::string progress = "auto";
    bool quiet = false;
};

[[noreturn]] void refuse(const std::string& message) { throw InputError(message); }

std::vector<FrameFile> chosen_frames(const RunFolder& folder, const std::string& frame) {
    if (frame == "all") return folder.frames;
    if (frame == "last") return {folder.frames.back()};
    std::uint64_t step = 0;
    const auto [stop, error] = std::from_chars(frame.data(), frame.data() + frame.size(), step);
    if (error != std::errc{} || stop != frame.data() + frame.size()) {
        refuse(fmt::format("--frame {}: expected a step number, last or all", frame));
    }
    for (const FrameFile& file : folder.frames) {
        if (file.step == step) return {file};
    }
    refuse(fmt::format("--frame {}: the run has no such frame; it has {} from step {} to {}", frame,
                       folder.frames.size(), folder.frames.front().step, folder.frames.back().step));
}

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

std::optional<ValueRange> parse_range(const std::string& text) {
    if (text.empty()) return std::nullopt;
    const std::vector<double> v = parse_number_list("--range", text);
    if (v.size() != 2 || !(v[0] < v[1])) refuse(fmt::format("--range {}: expected low,high with low < high", text));
    return ValueRange{v[0], v[1]};
}

ColorMap parse_color_map(const std::string& text) {
    if (const auto map = color_map_from_name(text)) return *map;
    refuse(fmt::format("--color-map {}: expected one of {}", text, fmt::join(color_map_names(), ", ")));
}

ParticleDrawing parse_drawing(const std::string& text) {
    if (text == "auto") return ParticleDrawing::automatic;
    if (text == "spheres") return ParticleDrawing::spheres;
    if (text == "soft") return ParticleDrawing::soft;
    if (text == "glow") return ParticleDrawing::glow;
    refuse(fmt::format("--draw {}: expected auto, spheres, soft or glow", text));
}

PictureStyle picture_style(const RenderArguments& arguments) {
    PictureStyle style;
    style.color_by = arguments.color_by;
    style.drawing = parse_drawing(arguments.drawing);
    style.range = parse_range(arguments.range);
    style.map = parse_color_map(arguments.color_map);
    if (arguments.particle_radius > 0.0) style.particle_radius = arguments.particle_radius;
    if (arguments.collider_color != "plain" && arguments.collider_color != "hits") {
        refuse(fmt::format("--collider-color {}: expected plain or hits", arguments.collider_color));
    }
    style.collider_hits = arguments.collider_color == "hits";
    style.hidden = arguments.hidden;
    style.glass = arguments.glass;
    style.camera = parse_camera(arguments.camera);
    style.up = parse_up(arguments.up);
    return style;
}

void check_numbers(const RenderArguments& arguments) {
    const auto in_range = [](const char* option, double value, double low, double high) {
        if (!(value >= low && value <= high)) refuse(fmt::format("{} {}: expected {} to {}", option, value, low, high));
    };
    in_range("--samples", arguments.samples, 1, 4096);
    in_range("--fps", arguments.frames_per_second, 1, 240);
    in_range("--exposure", arguments.exposure, 0.01, 100);
    in_range("--particle-radius", arguments.particle_radius, 0, 1e15);
}

// Shows how far the pictures are.
class Watch {
public:
    Watch(std::size_t pictures, const RenderArguments& arguments)
        : line_(arguments.quiet, parse_progress(arguments.progress)), pictures_(pictures) {}

    [[nodiscard]] std::function<void(double)> callback(std::size_t picture) {
        return [this, picture](double part) {
            if (!line_.due()) return;
            const double done = (static_cast<double>(picture) + part) / static_cast<double>(pictures_);
            const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
            line_.show(fmt::format("{:3.0f} %  picture {} of {}  {} left", 100.0 * done, picture + 1, pictures_,
                                   duration_text(spent / done - spent)));
        };
    }

private:
    ProgressLine line_;
    std::size_t pictures_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void write_film(RunPictures& pictures, const std::vector<FrameFile>& frames, PictureOptions options,
                const RenderArguments& arguments) {
    Film film(arguments.output, options.width, options.height, arguments.frames_per_second);
    Watch watch(frames.size(), arguments);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        options.progress = watch.callback(i);
        film.add(pictures.picture(frames[i], options));
    }
    film.finish();
}

std::filesystem::path numbered(const std::filesystem::path& path, std::uint64_t step) {
    return path.parent_path() / fmt::format("{}_{:06}{}", path.stem().string(), step, path.extension().string());
}

void write_pictures(RunPictures& pictures, const std::vector<FrameFile>& frames, PictureOptions options,
                    const RenderArguments& arguments) {
    const std::filesystem::path output = arguments.output;
    Watch watch(frames.size(), arguments);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        options.progress = watch.callback(i);
        const Image image = pictures.picture(frames[i], options);
        write_png(arguments.frame == "all" ? numbered(output, frames[i].step) : output, image);
    }
}

void require_room(const PictureSize& size, bool has_sprites, bool film, const std::string& text) {
    const double pixels = static_cast<double>(size.width) * static_cast<double>(size.height);
    const double bytes =
        picture_bytes(size.width, size.height, has_sprites) + (film ? pixels * Film::kBytesPerPixel : 0.0);
    require_memory(bytes, fmt::format("--size {}", text));
}

void render(const RenderArguments& arguments) {
    const std::string extension = std::filesystem::path(arguments.output).extension().string();
    if (extension != ".png" && extension != ".mp4") {
        refuse(fmt::format("--output {}: expected a name that ends in .png or .mp4", arguments.output));
    }
    check_numbers(arguments);
    (void)parse_progress(arguments.progress);  // wrong words are told before the work
    const PictureSize size = parse_picture_size(arguments.size);
    const bool film = extension == ".mp4";
    if (film && (size.width % 2 != 0 || size.height % 2 != 0)) {
        refuse(fmt::format("--size {}: a film needs an even width and height", arguments.size));
    }
    const PictureStyle style = picture_style(arguments);
    const RunFolder folder = open_run_folder(arguments.folder);
    const std::vector<FrameFile> frames =
        chosen_frames(folder, film && arguments.frame == "last" ? "all" : arguments.frame);
    const ThreadLimit limit(parse_thread_count(arguments.threads));
    RunPictures pictures(folder, frames, style, static_cast<double>(size.width) / size.height);
    require_room(size, pictures.draws_sprites(), film, arguments.size);
    const PictureOptions options{size.width, size.height, arguments.samples, arguments.exposure, arguments.night, {}};
    film ? write_film(pictures, frames, options, arguments) : write_pictures(pictures, frames, options, arguments);
    if (arguments.quiet) return;
    cli::print("{}: {} {}, ", arguments.output, frames.size(), frames.size() == 1 ? "frame" : "frames");
    if (pictures.shows_own_colors()) {
        cli::print("in the particles' own colours\n");
    } else {
        cli::print("{} from {:.4g} to {:.4g}\n", pictures.color_by(), pictures.range().low, pictures.range().high);
    }
}

void add_options(cli::Command command, RenderArguments& a) {
    command.add_option("DIR", a.folder, "Output folder of a run").required();
    command.add_option("--output", a.output, "Picture (.png) or film (.mp4, needs ffmpeg)").required();
    command.add_option("--frame", a.frame, "Step number, last, or all (numbered pictures)").show_default();
    command.add_option("--size", a.size, "WIDTHxHEIGHT in pixels").show_default();
    command.add_option("--camera", a.camera, "px,py,pz,tx,ty,tz[,fov]: position, target, vertical degrees");
    command.add_option("--up", a.up, "Axis that points up: x, y or z (default: against gravity)");
    command.add_option("--color-by", a.color_by,
                       "Array of the frames that colours the particles (default: their own color, or speed)");
    command
        .add_option("--draw", a.drawing,
                    "Particles as spheres, soft discs by opacity, or glow that adds up (auto: soft with an opacity)")
        .show_default();
    command.add_flag("--night", a.night, "A dark sky");
    command.add_option("--color-map", a.color_map, "viridis, plasma or turbo").show_default();
    command.add_option("--range", a.range, "low,high of the colours (default: from the frames)");
    command.add_option("--collider-color", a.collider_color, "plain, or hits per triangle").show_default();
    command.add_option("--hide", a.hidden, "Leave out the collider of this name (repeatable)").one_value_each();
    command.add_option("--glass", a.glass, "See through the collider of this name (repeatable)").one_value_each();
    command.add_option("--particle-radius", a.particle_radius, "Radius drawn, m (default: the particles' own)");
    command.add_option("--samples", a.samples, "Rays a pixel").show_default();
    command.add_option("--exposure", a.exposure, "Brightness factor").show_default();
    command.add_option("--fps", a.frames_per_second, "Pictures a second of a film").show_default();
    command.add_option("--threads", a.threads, "Worker threads (default: all)");
    command
        .add_option("--progress", a.progress,
                    "Show progress: auto on a terminal, always in a pipe too (a line every 10 s), never")
        .type_name("auto|always|never")
        .show_default();
    command.add_flag("--quiet", a.quiet, "No report, and no progress unless --progress always");
}

}  // namespace

void add_render_command(cli::Command program, int& exit_code) {
    cli::Command command = program.add_command("render", "Make a picture or a film of a run");
    const auto arguments = std::make_shared<RenderArguments>();
    add_options(command, *arguments);
    command.on_call([arguments, &exit_code] {
        render(*arguments);
        exit_code = 0;
    });
}

}  // namespace ricochet
