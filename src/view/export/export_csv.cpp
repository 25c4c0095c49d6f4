// Exports a finished run as tables of comma-separated values.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/core/error.h"
#include "run/csv_file.h"
#include "run/surface_groups.h"
#include "run/vtp_reader.h"
#include "view/export/export_folder.h"
#include "view/export/frame_reader.h"
#include "view/export/run_export.h"

namespace ricochet {
namespace {

constexpr const char* kContactTable = "contacts.csv";
constexpr const char* kTriangleTable = "triangles.csv";

/// Units of arrays, as pairs of array name and unit.
using Units = std::span<const std::pair<std::string_view, std::string_view>>;

constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kParticleUnits = {{{"velocity", "m/s"},
                                                                                          {"mass", "kg"},
                                                                                          {"radius", "m"},
                                                                                          {"age", "s"},
                                                                                          {"unsimulated_time", "s"},
                                                                                          {"spin", "rad/s"},
                                                                                          {"size", "m"},
                                                                                          {"temperature", "K"}}};
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kContactUnits = {{{"time", "s"},
                                                                                         {"velocity_before", "m/s"},
                                                                                         {"velocity_after", "m/s"},
                                                                                         {"impulse", "N s"},
                                                                                         {"radius", "m"},
                                                                                         {"surface_velocity", "m/s"}}};

std::string unit_of(const std::string& array, Units units) {
    const auto found = std::find_if(units.begin(), units.end(), [&](const auto& unit) { return unit.first == array; });
    return found == units.end() ? "" : fmt::format(" [{}]", found->second);
}

/// Header line of a table. Column names are made unique.
class Header {
public:
    void add(const std::string& name) {
        std::string unique = name;
        for (int k = 2; !used_.insert(unique).second; ++k) unique = fmt::format("{}_{}", name, k);
        text_ += (text_.empty() ? "" : ",") + csv_field(unique);
    }
    void add_vector(const std::string& name, const std::string& unit) {
        for (const char* axis : {"_x", "_y", "_z"}) add(name + axis + unit);
    }
    void add(const VtkArray& array, Units units) {
        const std::string unit = unit_of(array.name, units);
        std::holds_alternative<std::vector<Vec3>>(array.values) ? add_vector(array.name, unit) : add(array.name + unit);
    }
    void add_point() {
        for (const char* axis : {"x [m]", "y [m]", "z [m]"}) add(axis);
    }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::set<std::string> used_;
    std::string text_;
};

void add_value(CsvFile& file, const VtkArray& array, std::size_t row) {
    std::visit([&](const auto& values) { file.add(values[row]); }, array.values);
}

void write_particles(const std::filesystem::path& path, const VtkPolyData& frame) {
    Header header;
    header.add("time [s]");
    const VtkArray* const id = find_array(frame.point_arrays, "id");
    if (id != nullptr) header.add(*id, kParticleUnits);
    header.add_point();
    for (const VtkArray& array : frame.point_arrays) {
        if (&array != id) header.add(array, kParticleUnits);
    }
    CsvFile file(path, header.text());
    for (std::size_t i = 0; i < frame.points.size(); ++i) {
        file.add(frame.time);
        if (id != nullptr) add_value(file, *id, i);
        file.add(frame.points[i]);
        for (const VtkArray& array : frame.point_arrays) {
            if (&array != id) add_value(file, array, i);
        }
        file.end_row();
    }
    file.commit();
}

/// Writer of the contact log as one table.
class ContactTable {
public:
    ContactTable(std::filesystem::path path, const RunInfo& info) : path_(std::move(path)), info_(info) {}

    void add(const FrameFile& log) {
        const VtkPolyData rows = read_vtp(log.path);
        const std::string header = header_of(rows);
        if (!file_) file_.emplace(path_, header_ = header);
        if (header != header_) {
            throw InputError(fmt::format("{}: has other arrays than the contact files before", log.path.string()));
        }
        for (std::size_t i = 0; i < rows.points.size(); ++i) add(rows, i);
    }
    void commit() { file_->commit(); }

private:
    static constexpr const char* kCollider = "collider";

    static std::string header_of(const VtkPolyData& rows) {
        Header header;
        for (const VtkArray& array : rows.point_arrays) {
            header.add(array, kContactUnits);
            if (array.name == kCollider) header.add("collider_name");
        }
        header.add_point();
        return header.text();
    }

    // For an impact between two particles, the collider number is -1 and its name is empty.
    void add(const VtkPolyData& rows, std::size_t i) {
        for (const VtkArray& array : rows.point_arrays) {
            const auto* const colliders = std::get_if<std::vector<std::uint32_t>>(&array.values);
            if (array.name != kCollider || colliders == nullptr) {
                add_value(*file_, array, i);
                continue;
            }
            const std::uint32_t number = (*colliders)[i];
            const bool is_known = number < info_.colliders.size();
            file_->add(is_known ? std::int64_t{number} : -1);
            file_->add(is_known ? std::string_view(info_.colliders[number].name) : std::string_view());
        }
        file_->add(rows.points[i]);
        file_->end_row();
    }

    std::filesystem::path path_;
    const RunInfo& info_;
    std::string header_;
    std::optional<CsvFile> file_;
};

/// Writer of the rows of one collider's triangles. If the collider's file lacks an array, its columns stay empty.
class TriangleRows {
public:
    TriangleRows(const VtkPolyData& data, std::uint32_t number, std::string name, std::string_view type)
        : data_(data), number_(number), name_(std::move(name)) {
        is_plane_ = find_field(data, "plane_point") != nullptr;
        is_one_surface_ = is_plane_ || type == "sphere" || type == "cylinder";
    }

    static std::string header() {
        Header header;
        for (const char* name :
             {"collider", "collider_name", "triangle", "group", "group_name", "material", "material_name"}) {
            header.add(name);
        }
        header.add_point();
        for (const char* name : {"area [m2]", "hits [impacts]"}) header.add(name);
        header.add_vector("impulse", " [N s]");
        header.add_vector("lasting_impulse", " [N s]");
        return header.text();
    }

    // Planes, spheres and cylinders have one row, because the arrays store the total of the whole surface for each
    // triangle.
    void write(CsvFile& file, ImpulseSizes& sizes) const {
        const std::size_t rows = std::min<std::size_t>(data_.triangles.size(), is_one_surface_ ? 1 : SIZE_MAX);
        for (std::size_t t = 0; t < rows; ++t) {
            file.add(number_);
            file.add(name_);
            file.add(is_one_surface_ ? std::int64_t{-1} : static_cast<std::int64_t>(t));
            add_name(file, kGroupArray, kGroupNames, t);
            add_name(file, kMaterialArray, kMaterialNames, t);
            add_measures(file, t);
            add_array<std::int64_t>(file, "hits", t, 1);
            add_array<Vec3>(file, "impulse", t, 3);
            add_array<Vec3>(file, "lasting_impulse", t, 3);
            file.end_row();
            const auto* const impulse = values_of<Vec3>("impulse");
            const auto* const lasting = values_of<Vec3>("lasting_impulse");
            if (impulse != nullptr && lasting != nullptr) sizes.add((*impulse)[t], (*lasting)[t]);
        }
    }

private:
    template <class Value>
    [[nodiscard]] const std::vector<Value>* values_of(std::string_view name) const {
        const VtkArray* const array = find_array(data_.cell_arrays, name);
        return array == nullptr ? nullptr : std::get_if<std::vector<Value>>(&array->values);
    }

    template <class Value>
    void add_array(CsvFile& file, std::string_view name, std::size_t t, int fields) const {
        const auto* const values = values_of<Value>(name);
        values == nullptr ? file.skip(fields) : file.add((*values)[t]);
    }

    // Adds the number of the triangle's group or material, and the name for this number.
    void add_name(CsvFile& file, std::string_view array, std::string_view texts, std::size_t t) const {
        const auto* const numbers = values_of<std::uint32_t>(array);
        const std::vector<std::string>* const names = find_texts(data_, texts);
        if (numbers == nullptr) return file.skip(2);
        const std::uint32_t number = (*numbers)[t];
        file.add(number);
        names != nullptr&& number < names->size() ? file.add((*names)[number]) : file.skip(1);
    }

    void add_measures(CsvFile& file, std::size_t t) const {
        if (is_one_surface_) {
            file.skip(3);
            double area = 0.0;
            for (std::size_t k = 0; k < data_.triangles.size(); ++k) area += area_of(k);
            is_plane_ ? file.skip(1) : file.add(area);
            return;
        }
        const auto& [a, b, c] = data_.triangles[t];
        file.add((data_.points[a] + data_.points[b] + data_.points[c]) / 3.0);
        file.add(area_of(t));
    }

    [[nodiscard]] double area_of(std::size_t t) const {
        const auto& [a, b, c] = data_.triangles[t];
        return 0.5 * length(cross(data_.points[b] - data_.points[a], data_.points[c] - data_.points[a]));
    }

    const VtkPolyData& data_;
    std::uint32_t number_;
    std::string name_;
    bool is_plane_ = false;
    bool is_one_surface_ = false;
};

/// Sums over the triangles of all colliders, for the notes of the report.
struct TriangleSums {
    ImpulseSizes sizes;         ///< sums of the magnitudes of impulses, by impacts and by lasting contact
    std::optional<double> end;  ///< time, in s, up to which the totals count; set only if it is before the last frame
};

TriangleSums write_triangles(const std::filesystem::path& path, const RunFolder& folder) {
    CsvFile table(path, TriangleRows::header());
    TriangleSums sums;
    for (const std::filesystem::path& file : folder.colliders) {
        const std::string name = file.filename().string();
        const ColliderInfo* const info = folder.info.find(name);
        const auto number = static_cast<std::uint32_t>(index_of_collider_file(name).value_or(0));
        const VtkPolyData data = read_vtp(file);
        TriangleRows(data, number, info == nullptr ? file.stem().string() : info->name,
                     info == nullptr ? "" : info->type)
            .write(table, sums.sizes);
        if (has_incomplete_totals(folder, data.time)) sums.end = std::min(sums.end.value_or(data.time), data.time);
    }
    table.commit();
    return sums;
}

std::string table_of_frame(const FrameFile& frame) { return fmt::format("particles_{:06}.csv", frame.step); }

std::vector<std::string> table_names(const RunFolder& folder) {
    std::vector<std::string> names;
    for (const FrameFile& frame : folder.frames) names.push_back(table_of_frame(frame));
    if (!folder.contacts.empty()) names.emplace_back(kContactTable);
    if (!folder.colliders.empty()) names.emplace_back(kTriangleTable);
    return names;
}

void add_notes(const RunFolder& folder, const TriangleSums& sums, ExportReport& report) {
    const bool has_log = !folder.contacts.empty();
    if (!has_log) {
        report.notes.emplace_back("the run has no contact log; run the scene with --set output.contacts=true for one");
    }
    if (sums.end) {
        report.notes.push_back(fmt::format(
            "the run was interrupted: hits and impulses of {} end at {:.6g} s, before the last frame; go on with "
            "run --resume if it has a checkpoint, else run it again",
            kTriangleTable, *sums.end));
    }
    if (sums.sizes.lasting > 0.0) {
        report.notes.push_back(fmt::format(
            "impacts gave {:.3g} % of the impulse on surfaces; hits {} impacts only, contact that lasts is in "
            "lasting_impulse of {}",
            100.0 * sums.sizes.share_of_impacts(), has_log ? fmt::format("and {} hold", kContactTable) : "hold",
            kTriangleTable));
    }
    if (std::any_of(folder.info.colliders.begin(), folder.info.colliders.end(),
                    [](const auto& c) { return c.moves; })) {
        report.notes.push_back(
            fmt::format("{} has colliders that move in the coordinates of their frames", kTriangleTable));
    }
}

}  // namespace

ExportReport export_csv(const RunFolder& folder, const std::filesystem::path& target, const ExportProgress& progress) {
    ExportFolder output(target);  // constructed first, so that an unsuitable folder is reported before the work
    const std::vector<std::string> names = table_names(folder);
    output.begin(names);
    ExportReport report{names.size(), folder.frames.size(), {}};
    bool has_springs = false;
    for (std::size_t k = 0; k < folder.frames.size(); ++k) {
        const VtkPolyData frame = read_frame(folder.frames[k].path);
        has_springs = has_springs || !frame.lines.empty() || !frame.triangles.empty();
        write_particles(output.file(table_of_frame(folder.frames[k])), frame);
        progress(static_cast<double>(k + 1) / static_cast<double>(folder.frames.size()));
    }
    if (!folder.contacts.empty()) {
        ContactTable contacts(output.file(kContactTable), folder.info);
        for (const FrameFile& log : folder.contacts) contacts.add(log);
        contacts.commit();
    }
    const TriangleSums sums =
        folder.colliders.empty() ? TriangleSums{} : write_triangles(output.file(kTriangleTable), folder);
    add_notes(folder, sums, report);
    if (has_springs) report.notes.emplace_back("springs and cloth are left out");
    return report;
}

}  // namespace ricochet
