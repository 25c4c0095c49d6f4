#include "cli/run_pictures.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <numbers>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/io/moving_meshes.h"
#include "ricochet/io/vtk_reader.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves the declaration to the program

namespace ricochet::cli {

namespace {

std::vector<std::string> ffmpeg_arguments(const std::filesystem::path& output, int width, int height, int rate) {
    return {"ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-y",
            // in: raw pictures on standard input
            "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", fmt::format("{}x{}", width, height),
            "-framerate", std::to_string(rate), "-i", "pipe:0",
            // out: what every player understands
            "-c:v", "libx264", "-preset", "medium", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags", "+faststart",
            "-f", "mp4", "file:" + output.string()};
}

std::filesystem::path temporary_name(std::filesystem::path target) {
    return target += fmt::format(".{}.partial", ::getpid());
}

}  // namespace

Film::Film(std::filesystem::path target, int width, int height, int frames_per_second)
    : target_(std::move(target)), temporary_(temporary_name(target_)), unfinished_(temporary_) {
    (void)std::signal(SIGPIPE, SIG_IGN);  // a dead ffmpeg shows in write()
    messages_ = std::tmpfile();
    if (messages_ == nullptr) throw RunError(fmt::format("no temporary file for ffmpeg ({})", std::strerror(errno)));
    start(width, height, frames_per_second);
}

void Film::start(int width, int height, int frames_per_second) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        throw RunError(fmt::format("no pipe for ffmpeg ({})", std::strerror(errno)));
    std::vector<std::string> arguments = ffmpeg_arguments(temporary_, width, height, frames_per_second);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ::fileno(messages_), STDERR_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);  // Ctrl-C is for us; we end ffmpeg
    const int error = ::posix_spawnp(&process_, "ffmpeg", &actions, &attributes, pointers.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[0]);
    pipe_ = ends[1];
    if (error == 0) {
        unfinished_.set_writer(process_);
        return;
    }
    ::close(pipe_);
    (void)std::fclose(messages_);
    throw RunError(fmt::format("{}: ffmpeg cannot be started ({}); install ffmpeg, or give --output a .png name",
                               target_.string(), std::strerror(error)));
}

Film::~Film() {
    if (pipe_ >= 0) ::close(pipe_);
    if (process_ > 0) {
        (void)::kill(process_, SIGKILL);
        (void)wait();
    }
    (void)std::fclose(messages_);
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
}

int Film::wait() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
    process_ = -1;
    unfinished_.set_writer(0);
    return status;
}

void Film::fail() {
    if (pipe_ >= 0) ::close(std::exchange(pipe_, -1));
    if (process_ > 0) (void)wait();
    std::array<char, 400> text{};
    std::rewind(messages_);
    const char* line = std::fgets(text.data(), static_cast<int>(text.size()), messages_);
    std::string said = line == nullptr ? "it said nothing" : line;
    while (!said.empty() && said.back() == '\n') said.pop_back();
    throw RunError(fmt::format("{}: ffmpeg failed: {}", target_.string(), said));
}

void Film::add(const Image& image) {
    std::size_t written = 0;
    while (written < image.rgb.size()) {
        const ssize_t count = ::write(pipe_, image.rgb.data() + written, image.rgb.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail();
        written += static_cast<std::size_t>(count);
    }
}

void Film::finish() {
    ::close(std::exchange(pipe_, -1));
    if (wait() != 0) fail();
    std::error_code error;
    std::filesystem::rename(temporary_, target_, error);
    if (error) throw RunError(fmt::format("{}: cannot name the film ({})", target_.string(), error.message()));
}

namespace {

constexpr std::size_t kSurveyedFrames = 12;
constexpr const char* kSpeed = "speed";

// Muted earth and stone, so that the particles' colours stand out.
constexpr std::array<Vec3, 6> kColliderColors = {{{0.20, 0.18, 0.155},
                                                  {0.21, 0.23, 0.265},
                                                  {0.28, 0.23, 0.16},
                                                  {0.18, 0.21, 0.19},
                                                  {0.26, 0.19, 0.16},
                                                  {0.24, 0.26, 0.29}}};
constexpr Vec3 kGlassColor{0.30, 0.36, 0.42};
constexpr double kParticleAlbedo = 0.8;  // of the colour map's colours, so that sunlit ones do not burn out
constexpr Vec3 kPlaneColor{0.30, 0.30, 0.29};
constexpr Vec3 kRopeColor{0.55, 0.40, 0.20};
constexpr Vec3 kClothColor{0.42, 0.075, 0.06};
constexpr double kThreadRadius = 0.5;  // of a spring between points, over that of a point
constexpr double kBead = 1.5;          // a particle thicker than its threads by this factor is shown, not only threads

std::vector<FrameFile> spread_sample(const std::vector<FrameFile>& frames) {
    if (frames.size() <= kSurveyedFrames) return frames;
    std::vector<FrameFile> sample;
    for (std::size_t i = 0; i < kSurveyedFrames; ++i) {
        sample.push_back(frames[i * (frames.size() - 1) / (kSurveyedFrames - 1)]);
    }
    return sample;
}

std::string known_arrays(const VtkPolyData& frame) {
    std::string names = kSpeed;
    for (const VtkArray& array : frame.point_arrays) names += ", " + array.name;
    return names;
}

Vec3 vec3_of(const std::vector<double>& values) { return {values.at(0), values.at(1), values.at(2)}; }

// Counts span orders of magnitude: they are shown by their logarithm.
std::vector<Vec3> hit_colors(const VtkPolyData& collider, ColorMap map) {
    const VtkArray* hits = find_array(collider.cell_arrays, "hits");
    if (hits == nullptr) return {};
    std::vector<double> values = scalar_values(*hits);
    double largest = 1.0;
    for (double& value : values) {
        value = std::log1p(value);
        largest = std::max(largest, value);
    }
    std::vector<Vec3> colors;
    colors.reserve(values.size());
    for (const double value : values) colors.push_back(map_color(map, value / largest));
    return colors;
}

// Colliders of one material share a colour.
std::size_t color_index(const RunInfo& info, const std::filesystem::path& file) {
    for (const ColliderInfo& collider : info.colliders) {
        if (collider.file == file.filename().string()) return collider.material % kColliderColors.size();
    }
    return 0;
}

std::string collider_name(const RunInfo& info, const std::filesystem::path& file) {
    for (const ColliderInfo& collider : info.colliders) {
        if (collider.file == file.filename().string()) return collider.name;
    }
    return file.stem().string();
}

void check_names(const char* option, const std::vector<std::string>& names, const RunFolder& folder) {
    for (const std::string& name : names) {
        std::string known;
        bool found = false;
        for (const auto& file : folder.colliders) {
            const std::string other = collider_name(folder.info, file);
            known += (known.empty() ? "" : ", ") + other;
            found = found || other == name;
        }
        if (!found)
            throw InputError(fmt::format("{} {}: no such collider in the run; it has: {}", option, name, known));
    }
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

RunPictures::RunPictures(const RunFolder& folder, const std::vector<FrameFile>& chosen, PictureStyle style,
                         double aspect)
    : style_(std::move(style)) {
    check_names("--hide", style_.hidden, folder);
    check_names("--glass", style_.glass, folder);
    survey(chosen);
    load_colliders(folder);
    survey_moving(chosen);
    choose_camera(folder, aspect);
    preview_.emplace(std::move(meshes_), planes_, camera_.target);
}

void RunPictures::survey(const std::vector<FrameFile>& chosen) {
    std::vector<double> values;
    for (const FrameFile& file : spread_sample(chosen)) {
        const VtkPolyData frame = read_vtp(file.path);
        choose_looks(frame);
        const std::vector<double> here = shown_values(frame, file);
        values.insert(values.end(), here.begin(), here.end());
        subject_.particles.insert(subject_.particles.end(), frame.points.begin(), frame.points.end());
        most_particles_ = std::max(most_particles_, frame.points.size());
    }
    range_ = style_.range ? *style_.range : robust_range(std::move(values));
    if (!style_.range && style_.color_by == kSpeed) range_.low = 0.0;
}

// Settles what was left to the frames, and notes whether any particle has a size of its own.
void RunPictures::choose_looks(const VtkPolyData& frame) {
    const bool has_colors = find_array(frame.point_arrays, kColorAttribute) != nullptr;
    if (style_.color_by.empty()) style_.color_by = has_colors ? std::string(kColorAttribute) : kSpeed;
    own_colors_ = style_.color_by == kColorAttribute;
    if (style_.drawing == ParticleDrawing::automatic) {
        const bool soft = find_array(frame.point_arrays, kOpacityAttribute) != nullptr;
        style_.drawing = soft ? ParticleDrawing::soft : ParticleDrawing::spheres;
    }
    const VtkArray* const sizes = find_array(frame.point_arrays, kSizeAttribute);
    if (sizes == nullptr) return;
    const std::vector<double> values = scalar_values(*sizes);
    has_sizes_ = has_sizes_ || std::any_of(values.begin(), values.end(), [](double size) { return size > 0.0; });
}

void RunPictures::load_colliders(const RunFolder& folder) {
    for (const std::filesystem::path& file : folder.colliders) {
        const std::string name = collider_name(folder.info, file);
        const bool moves = folder.info.moves(file.filename().string());
        if (moves) {
            moving_looks_[static_cast<std::uint32_t>(index_of_collider_file(file.filename().string()).value_or(0))] = {
                contains(style_.glass, name) ? kGlassColor : kColliderColors[color_index(folder.info, file)],
                contains(style_.glass, name), contains(style_.hidden, name)};
        }
        if (moves || contains(style_.hidden, name)) continue;
        VtkPolyData data = read_vtp(file);
        const std::vector<double>* point = find_field(data, "plane_point");
        const std::vector<double>* normal = find_field(data, "plane_normal");
        if (point != nullptr && normal != nullptr && point->size() == 3 && normal->size() == 3) {
            planes_.push_back({vec3_of(*point), normalized(vec3_of(*normal)), kPlaneColor});
            continue;
        }
        subject_.colliders.insert(subject_.colliders.end(), data.points.begin(), data.points.end());
        std::vector<Vec3> colors = style_.collider_hits ? hit_colors(data, ColorMap::viridis) : std::vector<Vec3>{};
        meshes_.push_back({{std::move(data.points), std::move(data.triangles)},
                           contains(style_.glass, name) ? kGlassColor : kColliderColors[color_index(folder.info, file)],
                           std::move(colors),
                           contains(style_.glass, name)});
    }
}

// The picture is to show where they come.
void RunPictures::survey_moving(const std::vector<FrameFile>& chosen) {
    if (moving_looks_.empty()) return;
    for (const FrameFile& file : spread_sample(chosen)) {
        if (file.moving.empty()) continue;
        PreviewMoving moving;
        add_moving(file, moving);
        for (const PreviewMesh& mesh : moving.meshes) {
            subject_.colliders.insert(subject_.colliders.end(), mesh.mesh.vertices.begin(), mesh.mesh.vertices.end());
        }
    }
}

// One mesh a collider, with the vertices of all of them.
void RunPictures::add_moving(const FrameFile& file, PreviewMoving& moving) const {
    if (file.moving.empty()) return;
    for (auto& [collider, mesh] : read_moving_meshes(file)) {
        const auto looks = moving_looks_.find(collider);
        if (looks == moving_looks_.end() || looks->second.hidden) continue;
        moving.meshes.push_back({std::move(mesh), looks->second.color, {}, looks->second.glass});
    }
}

void RunPictures::choose_camera(const RunFolder& folder, double aspect) {
    const Vec3 up = style_.up ? *style_.up : folder.info.up;
    if (style_.camera) {
        camera_ = *style_.camera;
        camera_.up = up;
    } else if (folder.info.camera) {
        camera_ = {folder.info.camera->position, folder.info.camera->target, up,
                   folder.info.camera->field_of_view_degrees};
    } else {
        camera_ = automatic_camera(subject_, up, aspect);
    }
    subject_ = {};
}

std::vector<double> RunPictures::shown_values(const VtkPolyData& frame, const FrameFile& file) const {
    const bool speed = style_.color_by == kSpeed;
    const VtkArray* array = find_array(frame.point_arrays, speed ? "velocity" : style_.color_by);
    if (array == nullptr) {
        throw InputError(fmt::format("{}: no array named {}; known arrays: {}", file.path.string(), style_.color_by,
                                     known_arrays(frame)));
    }
    return scalar_values(*array);
}

// Points have no size: they get one that can be seen, the smaller the more there are.
double RunPictures::visible_radius() const {
    const double view =
        std::tan(0.5 * camera_.fov_degrees * std::numbers::pi / 180.0) * length(camera_.target - camera_.position);
    const double count = std::max(1.0, static_cast<double>(most_particles_));
    return view * std::clamp(0.8 / std::sqrt(count), 0.0029, 0.02);
}

std::vector<double> RunPictures::shown_radii(const VtkPolyData& frame) const {
    const VtkArray* own = find_array(frame.point_arrays, has_sizes_ ? kSizeAttribute : "radius");
    std::vector<double> radii = own == nullptr ? std::vector<double>(frame.points.size(), 0.0) : scalar_values(*own);
    const double visible = visible_radius();
    for (double& radius : radii) {
        if (style_.particle_radius) radius = *style_.particle_radius;
        if (!(radius > 0.0) && !has_sizes_) radius = visible;
    }
    return radii;
}

// Particles at the ends of springs are shown by their threads and cloth, unless they are thicker.
PreviewMoving RunPictures::moving(const VtkPolyData& frame, const FrameFile& file) const {
    const std::vector<Vec3> shown = colors(frame, file);
    const std::vector<double> radii = shown_radii(frame);
    const VtkArray* own = find_array(frame.point_arrays, "radius");
    const std::vector<double> own_radii = own == nullptr ? std::vector<double>(radii.size(), 0.0) : scalar_values(*own);
    std::vector<double> thread(frame.points.size(), 0.0);  // thickest one at the particle
    PreviewMoving moving;
    moving.lines.points = frame.points;
    for (const auto& [a, b] : frame.lines) {
        const bool have_size = own_radii[a] > 0.0 && own_radii[b] > 0.0;
        const double radius = std::min(radii[a], radii[b]) * (have_size ? 1.0 : kThreadRadius);
        moving.lines.ends.push_back({a, b});
        moving.lines.radii.push_back(radius);
        moving.lines.colors.push_back(kRopeColor);
        thread[a] = std::max(thread[a], radius);
        thread[b] = std::max(thread[b], radius);
    }
    std::vector<bool> is_cloth(frame.points.size(), false);
    for (const Triangle& triangle : frame.triangles) {
        for (const std::uint32_t corner : triangle) is_cloth[corner] = true;
    }
    moving.cloth.mesh = {frame.points, frame.triangles};
    moving.cloth.color = kClothColor;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const bool is_thread = thread[i] > 0.0 && (own_radii[i] == 0.0 || radii[i] <= kBead * thread[i]);
        if (is_thread || is_cloth[i]) continue;
        moving.spheres.centers.push_back(frame.points[i]);
        moving.spheres.radii.push_back(radii[i]);
        moving.spheres.colors.push_back(shown[i]);
    }
    return moving;
}

std::vector<Vec3> RunPictures::colors(const VtkPolyData& frame, const FrameFile& file) const {
    const VtkArray* const own = own_colors_ ? find_array(frame.point_arrays, kColorAttribute) : nullptr;
    const auto* const vectors = own == nullptr ? nullptr : std::get_if<std::vector<Vec3>>(&own->values);
    if (vectors != nullptr) return *vectors;
    std::vector<Vec3> colors;
    for (const double value : shown_values(frame, file)) {
        colors.push_back(kParticleAlbedo * map_color(style_.map, (value - range_.low) / (range_.high - range_.low)));
    }
    return colors;
}

Image RunPictures::picture(const FrameFile& file, const PictureOptions& options) {
    const VtkPolyData frame = read_vtp(file.path);
    PreviewMoving shown = moving(frame, file);
    add_moving(file, shown);
    if (!draws_sprites()) {
        preview_->set_moving(shown);
        return render_picture(*preview_, camera_, options);
    }
    shown.spheres = {};
    preview_->set_moving(shown);
    const VtkArray* const own = find_array(frame.point_arrays, kOpacityAttribute);
    std::vector<double> opacities =
        own == nullptr ? std::vector<double>(frame.points.size(), 1.0) : scalar_values(*own);
    const bool glow = style_.drawing == ParticleDrawing::glow;
    return render_picture(*preview_, camera_, options,
                          {frame.points, shown_radii(frame), colors(frame, file), std::move(opacities), glow});
}

}  // namespace ricochet::cli
