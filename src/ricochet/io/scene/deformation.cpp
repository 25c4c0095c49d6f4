// Deforming meshes: vertex positions over time, read from files.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/core/memory_limit.h"
#include "ricochet/geometry/mesh/mesh_motion.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/geometry/mesh/point_cache.h"
#include "ricochet/geometry/mesh/stretched_motion.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

namespace fs = std::filesystem;

struct FrameTimes {
    double frame_rate = 25.0;
    double start = 0.0;
};
struct DeformationKeys {
    MeshEnds ends = MeshEnds::hold;
};
struct MeshKey {
    double time = 0.0;
};

const ObjectSpec& mesh_key_spec() {
    static const ObjectSpec spec = object<MeshKey>(
        "mesh key", "Vertices of a mesh at a time.",
        {{"time", &MeshKey::time, kCoordinate, "s", "Time of the key, later than the previous key.", kRequired},
         {"file", ValueType::file, "OBJ, PLY or OFF file with the faces of the collider's `file`.", kRequired}});
    return spec;
}

/// Vertex positions at a sequence of times.
struct Series {
    std::vector<double> times;
    std::vector<std::vector<Vec3>> positions;
};

/// One file of a numbered series.
struct NumberedFile {
    std::uint64_t number = 0;
    fs::path path;
};

/// Exception that is thrown after an error has been reported with its source location.
struct Reported {};

constexpr std::string_view kSeriesName = "a file name with one * for the number, such as \"flag_*.obj\"";

// Returns a count with its noun, for example "1 vertex" or "2 vertices".
std::string counted(std::size_t count, std::string_view one, std::string_view many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

class DeformationBuilder {
public:
    DeformationBuilder(SceneContext& context, const ObjectView& collider, const ObjectView& view)
        : context_(context), collider_(collider), view_(view), base_(context.file_of(collider)), up_(up_of(collider)) {}

    /// Builds the motion. Throws InputError for a fault of the whole deformation. Throws Reported after reporting a
    /// fault of a key.
    [[nodiscard]] MeshMotion build() {
        Series series = view_.type() == "series" ? of_series() : view_.type() == "keys" ? of_keys() : of_cache();
        if (up_ == MeshUp::y) {
            for (std::vector<Vec3>& positions : series.positions) {
                for (Vec3& p : positions) p = y_up_as_z_up(p);
            }
        }
        const MeshEnds ends = view_.read<DeformationKeys>().ends;
        const std::size_t count = series.times.size();
        if (ends == MeshEnds::repeat && count > 1 && series.positions.front() != series.positions.back()) {
            series.times.push_back(series.times[count - 1] + (series.times[count - 1] - series.times[count - 2]));
            series.positions.push_back(series.positions.front());
        }
        return {std::move(series.times), std::move(series.positions), ends};
    }

private:
    [[nodiscard]] double time_of(double frame) const {
        const auto times = view_.read<FrameTimes>();
        return times.start + frame / times.frame_rate;
    }

    /// Returns the result of read(). If read() throws InputError, reports the error at this key and throws Reported.
    /// Also throws Reported if the key is absent, because an absent key has already been reported.
    template <class Read>
    auto from(const ObjectView& view, std::string_view key, const Read& read) const {
        if (!view.has(key)) throw Reported();
        try {
            return read();
        } catch (const InputError& problem) {
            context_.error(view, key, problem.what());
            throw Reported();
        }
    }

    [[nodiscard]] Series of_series() {
        const std::vector<NumberedFile> files = from(view_, "files", [&] { return numbered_files(); });
        read_base();
        Series series;
        for (const NumberedFile& file : files) {
            series.times.push_back(time_of(static_cast<double>(file.number - files.front().number)));
            series.positions.push_back(from(view_, "files", [&] { return vertices_of(file.path, files.size()); }));
        }
        return series;
    }

    [[nodiscard]] Series of_keys() {
        Series series;
        const std::vector<ObjectView> keys = view_.objects("keys");
        for (const ObjectView& key : keys) series.times.push_back(time_of(key, series.times));
        read_base();
        for (const ObjectView& key : keys) {
            series.positions.push_back(
                from(key, "file", [&] { return vertices_of(context_.file_of(key), keys.size()); }));
        }
        return series;
    }

    /// Returns the time of a key. before: times of the previous keys.
    [[nodiscard]] double time_of(const ObjectView& key, const std::vector<double>& before) const {
        return from(key, "time", [&] {
            const double time = key.read<MeshKey>().time;
            if (before.empty() || time > before.back()) return time;
            throw InputError(
                fmt::format("found {}, expected a time after that of the key before, {} s", time, before.back()));
        });
    }

    [[nodiscard]] Series of_cache() {
        PointCache cache = from(view_, "file", [&] {
            constexpr std::uint64_t kLargest = std::uint64_t{1} << 40;
            const fs::path path = context_.file_of(view_);
            return read_point_cache(path, read_bytes(path, kLargest));
        });
        read_base();
        from(view_, "file",
             [&] { require_as_many(cache.positions.front().size(), "point", "points", context_.file_of(view_)); });
        Series series{{}, std::move(cache.positions)};
        for (const double frame : cache.frames) series.times.push_back(time_of(frame));
        return series;
    }

    /// Returns the files whose names match a pattern with one * for a number, in the order of their numbers.
    [[nodiscard]] std::vector<NumberedFile> numbered_files() const {
        const fs::path pattern = context_.path_of_file(view_.text("files"));
        const std::string name = pattern.filename().string();
        const std::size_t star = name.find('*');
        if (star == std::string::npos || name.find('*', star + 1) != std::string::npos) {
            throw InputError(fmt::format("found \"{}\", expected {}", name, kSeriesName));
        }
        const std::string before = name.substr(0, star);
        const std::string after = name.substr(star + 1);
        std::vector<NumberedFile> files;
        std::error_code error;
        const fs::path folder = pattern.parent_path();
        for (fs::directory_iterator it(folder.empty() ? "." : folder, error), end; !error && it != end;
             it.increment(error)) {
            if (const auto number = number_in(it->path().filename().string(), before, after)) {
                files.push_back({*number, folder / it->path().filename()});
            }
        }
        std::ranges::sort(files, [](const NumberedFile& a, const NumberedFile& b) {
            return a.number != b.number ? a.number < b.number : a.path < b.path;
        });
        require_series(files, pattern);
        for (const NumberedFile& file : files) context_.note(file.path);
        return files;
    }

    static std::optional<std::uint64_t> number_in(const std::string& name, const std::string& before,
                                                  const std::string& after) {
        if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after)) {
            return std::nullopt;
        }
        const char* const first = name.data() + before.size();
        const char* const last = name.data() + name.size() - after.size();
        std::uint64_t number = 0;
        const auto [end, problem] = std::from_chars(first, last, number);
        return problem == std::errc() && end == last ? std::optional(number) : std::nullopt;
    }

    static void require_series(const std::vector<NumberedFile>& files, const fs::path& pattern) {
        if (files.size() < 2) {
            throw InputError(fmt::format("{}: found {}, expected at least 2", pattern.string(),
                                         counted(files.size(), "numbered file", "numbered files")));
        }
        for (std::size_t k = 1; k < files.size(); ++k) {
            if (files[k].number == files[k - 1].number + 1) continue;
            throw InputError(fmt::format("{}: number {} follows {}, expected consecutive numbers", pattern.string(),
                                         files[k].number, files[k - 1].number));
        }
    }

    /// Reads the mesh that defines the faces. If the collider's mesh is unreadable, this has already been reported.
    void read_base() {
        if (context_.load_groups(collider_) == nullptr) throw Reported();
        from(collider_, "file", [&] {
            mesh_ = read_mesh(base_);
            require_numbers(mesh_, base_);
        });
    }

    /// Returns the vertices of a mesh that must have the same faces as the base mesh. count: number of meshes of the
    /// series, for the memory check.
    [[nodiscard]] std::vector<Vec3> vertices_of(const fs::path& path, std::size_t count) {
        if (const auto problem = file_problem(path)) throw InputError(*problem);
        if (!asked_for_memory_) {
            const double bytes = static_cast<double>(mesh_.mesh.vertices.size() * sizeof(Vec3) * count);
            require_memory(2.0 * bytes, path.string());
        }
        asked_for_memory_ = true;
        ImportedMesh mesh = read_mesh(path);
        require_numbers(mesh, path);
        require_as_many(mesh.mesh.vertices.size(), "vertex", "vertices", path);
        if (mesh.polygons.face_offsets != mesh_.polygons.face_offsets ||
            mesh.polygons.corners != mesh_.polygons.corners) {
            throw InputError(
                fmt::format("{}: its faces are not those of {}, expected the same corners in the same "
                            "order",
                            path.string(), base_.string()));
        }
        return std::move(mesh.mesh.vertices);
    }

    /// Throws InputError unless there is one point per vertex of the base mesh.
    void require_as_many(std::size_t found, std::string_view one, std::string_view many, const fs::path& path) const {
        const std::size_t expected = mesh_.mesh.vertices.size();
        if (found == expected) return;
        throw InputError(fmt::format("{}: found {}, expected the {} of {}", path.string(), counted(found, one, many),
                                     counted(expected, "vertex", "vertices"), base_.string()));
    }

    // Refuses file formats whose vertices were merged by position, because such formats do not number their vertices.
    static void require_numbers(const ImportedMesh& mesh, const fs::path& path) {
        if (!mesh.weld) return;
        throw InputError(
            fmt::format("{}: found a file of the format {}, which has no numbered vertices; expected OBJ, "
                        "PLY or OFF",
                        path.string(), mesh.format));
    }

    SceneContext& context_;
    const ObjectView& collider_;
    const ObjectView& view_;
    fs::path base_;
    MeshUp up_;
    ImportedMesh mesh_;
    bool asked_for_memory_ = false;
};

/// Returns the mesh of a shape in the coordinates of its frame, or null for shapes without vertices.
std::shared_ptr<const TriangleMesh> mesh_within_frame(const ColliderShape& shape) {
    if (const auto* const box = std::get_if<CuboidShape>(&shape)) {
        return std::make_shared<const TriangleMesh>(transformed(cuboid_mesh(box->size), box->placement));
    }
    const auto* const mesh = std::get_if<MeshShape>(&shape);
    if (mesh == nullptr || !mesh->mesh) return nullptr;
    return std::make_shared<const TriangleMesh>(transformed(*mesh->mesh, mesh->placement));
}

/// Returns the message for a shape that cannot be scaled over time.
std::string without_vertices(std::string_view type, bool by_poses, const std::string& frame) {
    const std::string cause =
        by_poses ? "poses with \"scale\" move" : fmt::format("the frame \"{}\" is scaled, which moves", frame);
    return fmt::format("a {} keeps its size: {} the vertices of meshes and boxes, expected one of these, or {}", type,
                       cause, by_poses ? "no \"scale\"" : "a frame without a \"scale\"");
}

/// Returns the time range of the poses. Outside this range the collider is at rest, unless a parent frame moves.
std::pair<double, double> times_of(const std::vector<ObjectView>& poses) {
    const double begin = poses.front().node("time").number().value_or(0.0);
    const double end = poses.back().node("time").number().value_or(0.0);
    return {begin, std::max(end, begin + (poses.size() == 1 ? 1.0 : 0.0))};
}

}  // namespace

const ObjectSpec& deformation_spec() {
    using T = FrameTimes;
    static const Fields<T> frame_times{
        {"frame_rate", &T::frame_rate, positive_up_to(1e6), "1/s", "Frames per second."},
        {"start", &T::start, kCoordinate, "s", "Time of the first file, or of frame 0 of a cache."}};
    const auto timed = [](std::string_view name, std::string_view description, Fields<T> fields) {
        fields.insert(fields.end(), frame_times.begin(), frame_times.end());
        return variant<T>(name, description, fields);
    };
    static const ObjectSpec spec = object<DeformationKeys>(
        "deformation",
        "Positions of the vertices of a mesh over time. Between two keys each vertex moves on a straight line at "
        "constant speed. The collider's position, rotation and scale apply to all keys.",
        {{"ends", &DeformationKeys::ends, "Positions of the vertices before the first key and after the last key.",
          Choices{choice(MeshEnds::hold, "hold", "the vertices of that key, at rest"),
                  choice(MeshEnds::repeat, "repeat",
                         "the keys repeat. The change from the last key to the first takes the time between the last "
                         "two keys, unless both have identical vertices")}}},
        {timed("series", "A numbered series of meshes.",
               {{"files", ValueType::text,
                 "OBJ, PLY or OFF files with the faces of the collider's `file` and consecutive numbers.", kRequired,
                 Expected{kSeriesName}}}),
         variant<Unbound>(
             "keys", "Meshes with a time for each.",
             {{"keys", ValueType::list, "Keys in order of time.", &mesh_key_spec(), kRequired, kTwoOrMore}}),
         timed("cache", "A point cache beside the mesh, in the PC2 format.",
               {{"file", ValueType::file,
                 "Cache file with one point per vertex of the collider's `file`, in the same order. Its header gives "
                 "the start frame and the frames between samples.",
                 kRequired}})});
    return spec;
}

std::shared_ptr<const MeshMotion> deformation_of(SceneContext& context, const ObjectView& collider) {
    const ObjectView view = collider.object("deformation");
    if (view.is_absent() || view.type().empty() || !collider.has("file")) return nullptr;
    try {
        return std::make_shared<const MeshMotion>(DeformationBuilder(context, collider, view).build());
    } catch (const Reported&) {
        return nullptr;
    } catch (const InputError& problem) {
        if (!context.failed()) context.error(view, problem.what());
        return nullptr;
    }
}

bool stretch(SceneContext& context, const ObjectView& view, const SimulationOptions& options, const FrameTree& frames,
             const FrameDescription& own, ColliderDescription& collider) {
    const auto parent = frames.find(own.parent);
    const bool is_in_scaled = parent && frames.is_scaled(*parent);
    const bool is_scaled = std::ranges::any_of(
        own.motions, [](const FrameMotion& motion) { return std::holds_alternative<KeyedScale>(motion); });
    if ((!is_scaled && !is_in_scaled) || context.failed()) return is_scaled || is_in_scaled;
    const char* const key = is_scaled ? "motion" : "frame";
    const std::shared_ptr<const TriangleMesh> mesh = mesh_within_frame(collider.shape);
    if (mesh == nullptr) {
        context.error(view, key, without_vertices(view.type(), is_scaled, own.parent));
        return true;
    }
    try {
        const auto [begin, end] = own.parent.empty() ? times_of(view.objects("motion"))
                                                     : std::pair(0.0, options.duration + options.time_step);
        std::vector<FrameDescription> all{own};
        for (std::size_t k = 0; k < frames.size(); ++k) all.push_back(frames.description(k));
        MeshShape shape{mesh, {}, "", {}};
        shape.motion = std::make_shared<const MeshMotion>(
            stretched_motion(mesh->vertices, FrameTree(std::move(all)), 0, begin, end));
        if (const auto* was = std::get_if<MeshShape>(&collider.shape)) {
            shape.file = was->file;
            shape.triangle_materials = was->triangle_materials;
        }
        collider.shape = std::move(shape);
    } catch (const InputError& problem) {
        context.error(view, key, problem.what());
    }
    return true;
}

}  // namespace ricochet::detail
