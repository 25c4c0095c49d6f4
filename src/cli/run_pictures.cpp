#include "cli/run_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/dynamics/particles.h"
#include "run/camera_frames.h"
#include "run/vtp_reader.h"
#include "view/export/frame_reader.h"
#include "view/export/moving_meshes.h"
#include "view/render/black_body.h"
#include "view/render/sprites.h"

namespace ricochet::cli {

namespace {

constexpr const char* kSpeed = "speed";

// Muted earth and stone colours, so that the particles stand out.
constexpr std::array<Vec3, 6> kColliderColors = {{{0.20, 0.18, 0.155},
                                                  {0.21, 0.23, 0.265},
                                                  {0.28, 0.23, 0.16},
                                                  {0.18, 0.21, 0.19},
                                                  {0.26, 0.19, 0.16},
                                                  {0.24, 0.26, 0.29}}};
constexpr Vec3 kGlassColor{0.30, 0.36, 0.42};
constexpr Vec3 kEmberColor{0.06, 0.055, 0.05};

std::string known_arrays(const VtkPolyData& frame) {
    std::string names = kSpeed;
    for (const VtkArray& array : frame.point_arrays) names += ", " + array.name;
    return names;
}

Vec3 vec3_of(const std::vector<double>& values) { return {values.at(0), values.at(1), values.at(2)}; }

// Returns the index of a collider's colour. Colliders of one material share a colour.
std::size_t color_index(const RunInfo& info, const std::filesystem::path& file) {
    const ColliderInfo* const collider = info.find(file.filename().string());
    return collider == nullptr ? 0 : collider->material % kColliderColors.size();
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

std::vector<FrameFile> spread_sample(const std::vector<FrameFile>& frames) {
    constexpr std::size_t kSurveyedFrames = 12;
    if (frames.size() <= kSurveyedFrames) return frames;
    std::vector<FrameFile> sample;
    for (std::size_t i = 0; i < kSurveyedFrames; ++i) {
        sample.push_back(frames[i * (frames.size() - 1) / (kSurveyedFrames - 1)]);
    }
    return sample;
}

std::string collider_name(const RunInfo& info, const std::filesystem::path& file) {
    const ColliderInfo* const collider = info.find(file.filename().string());
    return collider == nullptr ? file.stem().string() : collider->name;
}

std::optional<ParticleDrawing> drawing_from_name(std::string_view name) {
    constexpr std::array<std::string_view, 7> kNames = {"auto", "spheres", "streaks", "soft",
                                                        "glow", "sprites", "meshes"};
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end()) return std::nullopt;
    return static_cast<ParticleDrawing>(found - kNames.begin());
}

RunPictures::RunPictures(const RunFolder& folder, const std::vector<FrameFile>& chosen, PictureStyle style,
                         double aspect)
    : style_(std::move(style)),
      timeline_(folder),
      colors_are_told_(!style_.color_by.empty()),
      is_told_(style_.drawing != ParticleDrawing::automatic) {
    check_names("--hide", style_.hidden, folder);
    check_names("--glass", style_.glass, folder);
    choose_scenery(folder.info);
    if (style_.particle_radius == 0.0) style_.particle_radius.reset();
    choose_shape(folder);
    survey(chosen);
    require_room_for_copies();
    load_colliders(folder);
    survey_moving(chosen);
    lay_ground(folder);
    choose_camera(folder, aspect);
    find_hiding(folder, chosen);
    preview_.emplace(std::move(meshes_), planes_, camera_.target);
    if (!shapes_.empty()) preview_->set_shapes(shapes_);
}

void RunPictures::survey(const std::vector<FrameFile>& chosen) {
    std::vector<double> values;
    for (const FrameFile& file : spread_sample(chosen)) {
        const VtkPolyData frame = read_frame(file.path);
        choose_looks(frame);
        const std::vector<double> here = shown_values(frame);
        values.insert(values.end(), here.begin(), here.end());
        subject_.particles.insert(subject_.particles.end(), frame.points.begin(), frame.points.end());
        widen_subject(frame);
        most_particles_ = std::max(most_particles_, frame.points.size());
    }
    range_ = style_.range ? *style_.range : robust_range(std::move(values));
    if (!style_.range && style_.color_by == kSpeed) range_.low = 0.0;
}

// Chooses automatic settings by the arrays of a frame. Records whether any particle has a size of its own.
void RunPictures::choose_looks(const VtkPolyData& frame) {
    const bool has_colors = find_array(frame.point_arrays, kColorAttribute) != nullptr;
    if (style_.color_by.empty()) {
        plain_image_ = std::all_of(drawings_.begin(), drawings_.end(),
                                   [](const Drawing& drawing) { return drawing.kind == ParticleDrawing::sprites; }) &&
                       !has_colors;
        embers_ = style_.black_body && !plain_image_ && !has_colors;
        style_.color_by = has_colors ? std::string(kColorAttribute) : kSpeed;
    }
    own_colors_ = style_.color_by == kColorAttribute;
    if (style_.drawing == ParticleDrawing::automatic) {
        const bool soft = find_array(frame.point_arrays, kOpacityAttribute) != nullptr;
        style_.drawing = soft ? ParticleDrawing::soft : ParticleDrawing::spheres;
        drawings_[0].kind = style_.drawing;
    }
    const VtkArray* const sizes = find_array(frame.point_arrays, kSizeAttribute);
    if (sizes == nullptr) return;
    const std::vector<double> values = scalar_values(*sizes);
    has_sizes_ = has_sizes_ || std::any_of(values.begin(), values.end(), [](double size) { return size > 0.0; });
}

// Returns the appearance of a collider. The command line overrides the scene.
RunPictures::Looks RunPictures::looks_of(const RunInfo& info, const std::filesystem::path& file) const {
    const std::string name = collider_name(info, file);
    ColliderLooks own;
    for (const ColliderInfo& collider : info.colliders) {
        if (collider.file == file.filename().string()) own = collider.looks;
    }
    Looks looks;
    looks.glass = own.glass || contains(style_.glass, name);
    looks.hidden = own.hidden || contains(style_.hidden, name);
    looks.roughness = own.roughness;
    looks.pattern = own.pattern;
    looks.color = own.color ? *own.color : looks.glass ? kGlassColor : kColliderColors[color_index(info, file)];
    looks.has_color = own.color.has_value();
    return looks;
}

void RunPictures::load_colliders(const RunFolder& folder) {
    for (const std::filesystem::path& file : folder.colliders) {
        const Looks looks = looks_of(folder.info, file);
        const bool moves = folder.info.moves(file.filename().string());
        if (moves) {
            const auto index = index_of_collider_file(file.filename().string());
            moving_looks_[static_cast<std::uint32_t>(index.value_or(0))] = looks;
            moving_files_[static_cast<std::uint32_t>(index.value_or(0))] = file;
        }
        if (moves || looks.hidden) continue;
        VtkPolyData data = read_vtp(file);
        const std::vector<double>* point = find_field(data, "plane_point");
        const std::vector<double>* normal = find_field(data, "plane_normal");
        if (point != nullptr && normal != nullptr && point->size() == 3 && normal->size() == 3) {
            planes_.push_back({vec3_of(*point), normalized(vec3_of(*normal)),
                               looks.has_color ? looks.color : kPlaneColor, looks.roughness, !looks.pattern});
            continue;
        }
        subject_.colliders.insert(subject_.colliders.end(), data.points.begin(), data.points.end());
        mesh_files_.push_back(file);
        meshes_.push_back(
            {{std::move(data.points), std::move(data.triangles)}, looks.color, {}, looks.glass, looks.roughness});
    }
    if (style_.collider_quantity) color_colliders(folder);
}

// Includes the positions of moving colliders in the view.
void RunPictures::survey_moving(const std::vector<FrameFile>& chosen) {
    if (moving_looks_.empty()) return;
    for (const FrameFile& file : spread_sample(chosen)) {
        if (file.moving.empty()) continue;
        PreviewMoving moving;
        add_moving(read_moving_meshes(file), moving);
        for (const PreviewMesh& mesh : moving.meshes) {
            subject_.colliders.insert(subject_.colliders.end(), mesh.mesh.vertices.begin(), mesh.mesh.vertices.end());
        }
    }
}

// Adds one mesh per moving collider.
void RunPictures::add_moving(std::map<std::uint32_t, TriangleMesh> meshes, PreviewMoving& moving) const {
    for (auto& [collider, mesh] : meshes) {
        const auto looks = moving_looks_.find(collider);
        if (looks == moving_looks_.end() || looks->second.hidden) continue;
        const auto colors = moving_colors_.find(collider);
        const bool has_quantity = colors != moving_colors_.end() && colors->second.size() == mesh.triangles.size();
        moving.meshes.push_back({std::move(mesh), looks->second.color,
                                 has_quantity ? colors->second : std::vector<Vec3>{}, looks->second.glass,
                                 looks->second.roughness});
    }
}

std::vector<double> RunPictures::shown_values(const VtkPolyData& frame) const {
    const bool speed = style_.color_by == kSpeed;
    const VtkArray* array = find_array(frame.point_arrays, speed ? "velocity" : style_.color_by);
    if (array == nullptr) {
        throw InputError(fmt::format("--color-by {}: the frames have no such array; known arrays: {}", style_.color_by,
                                     known_arrays(frame)));
    }
    return scalar_values(*array);
}

// Returns a visible radius for points, which have no size. The radius decreases with the number of particles.
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

std::vector<Vec3> RunPictures::colors(const VtkPolyData& frame) const {
    if (plain_image_) return std::vector<Vec3>(frame.points.size(), Vec3{1, 1, 1});
    if (embers_) return std::vector<Vec3>(frame.points.size(), kEmberColor);
    const VtkArray* const own = own_colors_ ? find_array(frame.point_arrays, kColorAttribute) : nullptr;
    const auto* const vectors = own == nullptr ? nullptr : std::get_if<std::vector<Vec3>>(&own->values);
    if (vectors != nullptr) return *vectors;
    std::vector<Vec3> colors;
    for (const double value : shown_values(frame)) {
        colors.push_back(kParticleAlbedo * map_color(style_.map, (value - range_.low) / (range_.high - range_.low)));
    }
    return colors;
}

std::vector<Vec3> RunPictures::emissions(const VtkPolyData& frame) const {
    constexpr double kSunlit = 4.0;  // light of a white surface in the sun
    std::vector<Vec3> lights;
    if (!style_.black_body) return lights;
    const VtkArray* const array = find_array(frame.point_arrays, kTemperature);
    if (array == nullptr) {
        throw InputError(fmt::format("--black-body {}: the frames have no array {}; known arrays: {}",
                                     *style_.black_body, kTemperature, known_arrays(frame)));
    }
    const BlackBody body(*style_.black_body);
    for (const double kelvin : scalar_values(*array)) lights.push_back(kSunlit * body.light(kelvin));
    return lights;
}

// Returns the colours of discs and images. Each colour combines emitted and reflected light.
std::vector<Vec3> RunPictures::sprite_colors(const VtkPolyData& frame, ParticleDrawing kind) const {
    if (emissions_.empty()) return colors(frame);
    if (kind == ParticleDrawing::glow) return emissions_;
    std::vector<Vec3> sum = colors(frame);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += emissions_[i] / kSpriteDaylight;
    return sum;
}

}  // namespace ricochet::cli
