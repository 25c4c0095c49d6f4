#include "cli/run_timeline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>
#include <variant>

#include "run/vtp_reader.h"
#include "view/export/frame_reader.h"
#include "view/export/moving_meshes.h"

namespace ricochet::cli {
namespace {

constexpr double kSameTime = 1e-9;  // largest difference of equal times, relative to the time between two frames

template <class Value>
const std::vector<Value>& values_of(const VtkPolyData& data, const char* name) {
    static const std::vector<Value> kNone;
    const VtkArray* array = find_array(data.point_arrays, name);
    const auto* values = array == nullptr ? nullptr : std::get_if<std::vector<Value>>(&array->values);
    return values == nullptr ? kNone : *values;
}

double mixed(double a, double b, double t) { return (1.0 - t) * a + t * b; }
Vec3 mixed(const Vec3& a, const Vec3& b, double t) { return (1.0 - t) * a + t * b; }
template <class Whole>
Whole mixed(Whole a, Whole /*b*/, double /*t*/) {
    return a;
}

constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

// Replaces the nearest impact of each particle if the contact log has a nearer one. For an impact of two spheres, the
// log has the velocities of only one sphere. The normal component of its velocity change then replaces the approach
// speed.
void add_near_impacts(const VtkPolyData& log, double time, double reach,
                      const std::unordered_map<std::int64_t, std::size_t>& rows, std::vector<NearImpact>& nearest) {
    const auto& particles = values_of<std::int64_t>(log, "particle");
    const auto& others = values_of<std::int64_t>(log, "other");
    const auto& times = values_of<double>(log, "time");
    const auto& normals = values_of<Vec3>(log, "normal");
    const auto& before = values_of<Vec3>(log, "velocity_before");
    const auto& after = values_of<Vec3>(log, "velocity_after");
    const auto& surface = values_of<Vec3>(log, "surface_velocity");
    const auto note = [&](std::int64_t id, const NearImpact& impact) {
        const auto found = rows.find(id);
        if (found == rows.end() || impact.away > reach || !(impact.speed > 0.0)) return;
        NearImpact& known = nearest[found->second];
        if (known.speed == 0.0 || impact.away < known.away) known = impact;
    };
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double away = std::fabs(times[i] - time);
        const std::int64_t other = i < others.size() ? others[i] : -1;
        if (other >= 0) {
            const double speed = dot(after[i] - before[i], normals[i]);
            note(particles[i], {away, speed, normals[i]});
            note(other, {away, speed, -normals[i]});
        } else {
            const Vec3 carried = i < surface.size() ? surface[i] : Vec3{};
            note(particles[i], {away, dot(carried - before[i], normals[i]), normals[i]});
        }
    }
}

/// Copies arrays. The values are first copied and then moved into a variant. Reason: an allocation failure inside a
/// variant's copy corrupts the variant; see list_of().
std::vector<VtkArray> copies_of(const std::vector<VtkArray>& arrays) {
    std::vector<VtkArray> copies;
    copies.reserve(arrays.size());
    for (const VtkArray& array : arrays) {
        copies.push_back(std::visit(
            [&](auto values) {
                return VtkArray{array.name, std::move(values)};
            },
            array.values));
    }
    return copies;
}

VtkPolyData copy_of(const VtkPolyData& frame) {
    VtkPolyData copy;
    copy.time = frame.time;
    copy.fields = frame.fields;
    copy.points = frame.points;
    copy.point_arrays = copies_of(frame.point_arrays);
    copy.lines = frame.lines;
    copy.triangles = frame.triangles;
    copy.has_vertices = frame.has_vertices;
    copy.cell_arrays = copies_of(frame.cell_arrays);
    return copy;
}

}  // namespace

// The particles at one time. Contains the row of each particle in the previous and in the next frame, and a lookup by
// id.
struct RunTimeline::Rows {
    std::vector<std::size_t> before;
    std::vector<std::size_t> after;
    std::unordered_map<std::int64_t, std::size_t> by_id;

    [[nodiscard]] std::size_t size() const { return before.size(); }
    void add(std::int64_t id, std::size_t row_before, std::size_t row_after) {
        by_id.emplace(id, before.size());
        before.push_back(row_before);
        after.push_back(row_after);
    }
};

RunTimeline::RunTimeline(const RunFolder& folder) : files_(folder.frames) {
    for (const FrameFile& file : folder.contacts) contacts_.emplace(file.step, file.path);
}

const VtkPolyData& RunTimeline::frame(std::size_t k) {
    auto& slot = loaded_[k];
    if (!slot) slot = std::make_shared<const VtkPolyData>(read_frame(files_[k].path));
    return *slot;
}

const VtkPolyData& RunTimeline::contact_log(std::uint64_t step, const std::filesystem::path& path) {
    auto& slot = loaded_contacts_[step];
    if (!slot) slot = std::make_shared<const VtkPolyData>(read_vtp(path));
    return *slot;
}

double RunTimeline::time_of(std::size_t k) { return frame(k).time; }

double RunTimeline::go_to(std::uint64_t step) {
    const auto found = std::find_if(files_.begin(), files_.end(), [&](const FrameFile& f) { return f.step == step; });
    current_ = found == files_.end() ? 0 : static_cast<std::size_t>(found - files_.begin());
    return time_of(current_);
}

bool RunTimeline::is_at(std::size_t k, double time) {
    const double step = k + 1 < files_.size() ? time_of(k + 1) - time_of(k) : 1.0;
    return std::fabs(time - time_of(k)) <= kSameTime * step;
}

std::size_t RunTimeline::index_at(double time) {
    while (current_ > 0 && time_of(current_) > time) --current_;
    while (current_ + 1 < files_.size() && (time_of(current_ + 1) <= time || is_at(current_ + 1, time))) ++current_;
    return current_;
}

RunTimeline::Rows RunTimeline::rows_at(std::size_t k, bool exact, double time) {
    Rows rows;
    const std::vector<std::int64_t>& ids = values_of<std::int64_t>(frame(k), "id");
    for (std::size_t i = 0; i < frame(k).points.size(); ++i) {
        rows.add(i < ids.size() ? ids[i] : static_cast<std::int64_t>(i), i, kNowhere);
    }
    if (exact) return rows;
    const VtkPolyData& next = frame(k + 1);
    const std::vector<std::int64_t>& later = values_of<std::int64_t>(next, "id");
    const std::vector<double>& ages = values_of<double>(next, "age");
    for (std::size_t j = 0; j < later.size(); ++j) {
        const auto found = rows.by_id.find(later[j]);
        if (found != rows.by_id.end()) {
            rows.after[found->second] = j;
        } else if (j < ages.size() && next.time - ages[j] <= time) {
            rows.add(later[j], kNowhere, j);
        }
    }
    return rows;
}

void RunTimeline::add_frame_nodes(std::size_t first, std::size_t last, const Rows& rows, ShutterPaths& paths) {
    for (std::size_t k = first; k <= last; ++k) {
        const VtkPolyData& state = frame(k);
        const std::vector<std::int64_t>& ids = values_of<std::int64_t>(state, "id");
        const std::vector<Vec3>& velocities = values_of<Vec3>(state, "velocity");
        for (std::size_t i = 0; i < std::min(ids.size(), velocities.size()); ++i) {
            const auto found = rows.by_id.find(ids[i]);
            if (found == rows.by_id.end()) continue;
            paths.nodes[found->second].push_back({state.time, state.points[i], velocities[i], velocities[i]});
        }
    }
}

void RunTimeline::add_impact_nodes(std::size_t first, std::size_t last, const Rows& rows, ShutterPaths& paths) {
    if (first == last) return;
    // The contact file named by a frame's step contains the impacts before that frame. Large logs have additional files
    // between two frames.
    const auto begin = contacts_.upper_bound(files_[first].step);
    const auto end = contacts_.upper_bound(files_[last].step);
    for (auto file = begin; file != end; ++file) {
        const VtkPolyData& log = contact_log(file->first, file->second);
        const std::vector<std::int64_t>& particles = values_of<std::int64_t>(log, "particle");
        const std::vector<double>& times = values_of<double>(log, "time");
        const std::vector<double>& radii = values_of<double>(log, "radius");
        const std::vector<Vec3>& normals = values_of<Vec3>(log, "normal");
        const std::vector<Vec3>& before = values_of<Vec3>(log, "velocity_before");
        const std::vector<Vec3>& after = values_of<Vec3>(log, "velocity_after");
        for (std::size_t i = 0; i < particles.size(); ++i) {
            const auto found = rows.by_id.find(particles[i]);
            if (found == rows.by_id.end()) continue;
            const Vec3 center = log.points[i] + radii[i] * normals[i];
            paths.nodes[found->second].push_back({times[i], center, before[i], after[i]});
        }
    }
    for (std::vector<PathNode>& nodes : paths.nodes) {
        std::stable_sort(nodes.begin(), nodes.end(),
                         [](const PathNode& a, const PathNode& b) { return a.time < b.time; });
    }
}

std::vector<NearImpact> RunTimeline::impacts_near(const VtkPolyData& frame, double time, double reach) {
    std::vector<NearImpact> nearest(frame.points.size());
    std::unordered_map<std::int64_t, std::size_t> rows;
    for (const std::int64_t id : values_of<std::int64_t>(frame, "id")) rows.emplace(id, rows.size());
    std::size_t first = index_at(time);
    std::size_t last = first;
    while (first > 0 && time_of(first) > time - reach) --first;
    while (last + 1 < files_.size() && time_of(last) < time + reach) ++last;
    const auto end = contacts_.upper_bound(files_[last].step);
    for (auto file = contacts_.upper_bound(files_[first].step); file != end; ++file) {
        const VtkPolyData& log = contact_log(file->first, file->second);
        add_near_impacts(log, time, reach, rows, nearest);
    }
    return nearest;
}

void RunTimeline::set_births(std::size_t last, const Rows& rows, ShutterPaths& paths) {
    paths.born.assign(rows.size(), paths.open);
    const VtkPolyData& state = frame(last);
    const std::vector<std::int64_t>& ids = values_of<std::int64_t>(state, "id");
    const std::vector<double>& ages = values_of<double>(state, "age");
    for (std::size_t i = 0; i < std::min(ids.size(), ages.size()); ++i) {
        const auto found = rows.by_id.find(ids[i]);
        if (found == rows.by_id.end()) continue;
        paths.born[found->second] = std::max(paths.open, state.time - ages[i]);
    }
}

void RunTimeline::drop_ended(double time, Rows& rows, ShutterPaths& paths) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const bool ended = rows.after[i] == kNowhere && (paths.nodes[i].empty() || paths.nodes[i].back().time < time);
        if (ended) continue;
        rows.before[kept] = rows.before[i];
        rows.after[kept] = rows.after[i];
        paths.born[kept] = paths.born[i];
        if (kept != i) paths.nodes[kept] = std::move(paths.nodes[i]);
        ++kept;
    }
    rows.before.resize(kept);
    rows.after.resize(kept);
    paths.nodes.resize(kept);
    paths.born.resize(kept);
}

VtkPolyData RunTimeline::mixed_frame(std::size_t k, double time, const Rows& rows, const ShutterPaths& paths) {
    const VtkPolyData& a = frame(k);
    const VtkPolyData& b = frame(k + 1);
    const double t = (time - a.time) / (b.time - a.time);
    VtkPolyData out;
    out.time = time;
    for (std::size_t i = 0; i < rows.size(); ++i) out.points.push_back(position_on_path(paths.nodes[i], time));
    for (const VtkArray& array : a.point_arrays) {
        const VtkArray* other = find_array(b.point_arrays, array.name);
        if (other == nullptr || other->values.index() != array.values.index()) continue;
        std::visit(
            [&](const auto& first) {
                using Values = std::remove_cvref_t<decltype(first)>;
                const Values& second = std::get<Values>(other->values);
                Values mix;
                for (std::size_t i = 0; i < rows.size(); ++i) {
                    const auto& one = rows.before[i] == kNowhere ? second[rows.after[i]] : first[rows.before[i]];
                    const auto& two = rows.after[i] == kNowhere ? one : second[rows.after[i]];
                    mix.push_back(mixed(one, two, t));
                }
                out.point_arrays.push_back({array.name, std::move(mix)});
            },
            array.values);
    }
    for (const VtkField& field : a.fields) {
        const std::vector<double>* other = find_field(b, field.name);
        VtkField mix = field;
        for (std::size_t i = 0; other != nullptr && i < mix.values.size() && i < other->size(); ++i) {
            mix.values[i] = mixed(field.values[i], (*other)[i], t);
        }
        out.fields.push_back(std::move(mix));
    }
    // Lines and triangles are copied unchanged, because all particles of threads and cloth exist in both frames.
    out.lines = a.lines;
    out.triangles = a.triangles;
    out.has_vertices = a.has_vertices;
    return out;
}

void RunTimeline::add_moving(std::size_t k, bool exact, double time, Moment& moment) {
    if (files_[k].moving.empty()) return;
    moment.moving = read_moving_meshes(files_[k]);
    if (exact || files_[k + 1].moving.empty()) return;
    const auto later = read_moving_meshes(files_[k + 1]);
    const double t = (time - time_of(k)) / (time_of(k + 1) - time_of(k));
    for (auto& [collider, mesh] : moment.moving) {
        std::vector<Vec3>& vertices = mesh.vertices;
        const auto found = later.find(collider);
        if (found == later.end() || found->second.vertices.size() != vertices.size()) continue;
        const std::vector<Vec3>& next = found->second.vertices;
        for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = mixed(vertices[v], next[v], t);
    }
}

Moment RunTimeline::at(double time, double shutter) {
    const std::size_t k = index_at(time);
    const bool exact = k + 1 == files_.size() || is_at(k, time);
    std::size_t first = k;
    if (exact) time = time_of(k);
    while (first > 0 && time_of(first) > time - shutter) --first;
    const std::size_t last = exact ? k : k + 1;
    Moment moment;
    moment.paths.open = time - shutter;
    moment.paths.close = time;
    if (exact && !(shutter > 0.0)) {
        moment.frame = copy_of(frame(k));
    } else {
        Rows rows = rows_at(k, exact, time);
        moment.paths.nodes.resize(rows.size());
        add_frame_nodes(first, last, rows, moment.paths);
        add_impact_nodes(first, last, rows, moment.paths);
        set_births(last, rows, moment.paths);
        if (!exact && frame(k).lines.empty() && frame(k).triangles.empty()) drop_ended(time, rows, moment.paths);
        moment.frame = exact ? copy_of(frame(k)) : mixed_frame(k, time, rows, moment.paths);
        if (!(shutter > 0.0)) moment.paths.nodes.clear();
    }
    add_moving(k, exact, time, moment);
    std::erase_if(loaded_, [&](const auto& one) { return one.first < first || one.first > last; });
    std::erase_if(loaded_contacts_, [&](const auto& one) { return one.first < files_[first].step; });
    return moment;
}

}  // namespace ricochet::cli
