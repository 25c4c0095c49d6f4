#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "lab/bench/case_run.h"
#include "lab/bench/cases.h"
#include "lab/bench/load.h"
#include "lab/bench/timing.h"
#include "ricochet/collision/collision_world.h"
#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "run/mesh_writer.h"

namespace ricochet::bench {

namespace {

constexpr std::size_t kFew = 20'000;
constexpr std::size_t kMany = 1'000'000;
constexpr std::size_t kMost = 5'000'000;

// The mesh writer of the library writes only binary PLY files.
void write_ascii_ply(const TriangleMesh& mesh, const std::filesystem::path& path) {
    std::string text = fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.vertices.size(), mesh.triangles.size());
    for (const Vec3& v : mesh.vertices) fmt::format_to(std::back_inserter(text), "{} {} {}\n", v.x, v.y, v.z);
    for (const Triangle& t : mesh.triangles) fmt::format_to(std::back_inserter(text), "3 {} {} {}\n", t[0], t[1], t[2]);
    write_file(path, text);
}

}  // namespace

std::string_view name_of(FileForm form) {
    switch (form) {
        case FileForm::obj:
            return "OBJ";
        case FileForm::binary_ply:
            return "PLY, binary";
        case FileForm::ascii_ply:
            return "PLY, ASCII";
        case FileForm::binary_stl:
            return "STL, binary";
        case FileForm::off:
            return "OFF";
    }
    throw InputError("a benchmark case has an unknown file format");
}

std::string_view ending_of(FileForm form) {
    switch (form) {
        case FileForm::obj:
            return ".obj";
        case FileForm::binary_ply:
        case FileForm::ascii_ply:
            return ".ply";
        case FileForm::binary_stl:
            return ".stl";
        case FileForm::off:
            return ".off";
    }
    throw InputError("a benchmark case has an unknown file format");
}

const std::vector<LoadCase>& load_cases() {
    static const std::vector<LoadCase> cases = {
        {"obj-20k", FileForm::obj, kFew},
        {"ply-20k", FileForm::binary_ply, kFew},
        {"ascii-ply-20k", FileForm::ascii_ply, kFew},
        {"stl-20k", FileForm::binary_stl, kFew},
        {"off-20k", FileForm::off, kFew},
        {"obj-1M", FileForm::obj, kMany},
        {"ply-1M", FileForm::binary_ply, kMany},
        {"ascii-ply-1M", FileForm::ascii_ply, kMany},
        {"stl-1M", FileForm::binary_stl, kMany},
        {"off-1M", FileForm::off, kMany},
        {"ply-5M", FileForm::binary_ply, kMost},
    };
    return cases;
}

TriangleMesh make_mesh(const LoadCase& c) { return *make_mesh(Case{.triangles = c.triangles}); }

void write_form(const TriangleMesh& mesh, const std::filesystem::path& path, FileForm form) {
    if (form == FileForm::ascii_ply) {
        write_ascii_ply(mesh, path);
    } else {
        write_mesh(mesh, path);
    }
}

namespace {

namespace fs = std::filesystem;

/// Temporary folder. The destructor removes the folder and its contents.
class ScratchFolder {
public:
    ScratchFolder() {
        std::string name = (fs::temp_directory_path() / "ricochet-bench-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) {
            throw RunError(fmt::format("{}: no folder for the benchmark's files ({})", name, std::strerror(errno)));
        }
        path_ = name;
    }
    ~ScratchFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    [[nodiscard]] const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

/// Measurement of one file.
class LoadMeasurer {
public:
    LoadMeasurer(const LoadCase& c, const MeasurementPlan& plan, const Hook& hook)
        : case_(c), plan_(plan), hook_(hook), file_(folder_.path() / fmt::format("{}{}", c.name, ending_of(c.form))) {}

    std::optional<std::vector<LoadRow>> run() {
        progress_.name = case_.name;
        if (!announce("mesh file")) return std::nullopt;
        write();
        std::vector<std::vector<double>> builds(plan_.threads.size());
        for (std::uint32_t repeat = 1; repeat <= plan_.repeats; ++repeat) {
            progress_.repeat = repeat;
            if (!time_all(builds)) return std::nullopt;
        }
        return rows(builds);
    }

private:
    bool announce(std::string_view doing) {
        progress_.doing = doing;
        return !hook_ || hook_(progress_);
    }

    void write() {
        const TriangleMesh mesh = make_mesh(case_);
        write_form(mesh, file_, case_.form);
        triangles_ = mesh.triangles.size();
    }

    bool time_all(std::vector<std::vector<double>>& builds);
    [[nodiscard]] std::shared_ptr<const TriangleMesh> time_reading();
    [[nodiscard]] std::vector<LoadRow> rows(const std::vector<std::vector<double>>& builds) const;

    const LoadCase& case_;
    const MeasurementPlan& plan_;
    const Hook& hook_;
    ScratchFolder folder_;
    fs::path file_;
    Progress progress_;
    std::size_t triangles_ = 0;
    std::vector<double> reads_;
    std::vector<int> threads_;
};

std::shared_ptr<const TriangleMesh> LoadMeasurer::time_reading() {
    ImportedMesh imported;
    reads_.push_back(time_of([&] { imported = read_mesh(file_); }));
    if (imported.mesh.triangles.size() != triangles_) {
        throw RunError(fmt::format("{} of suite load: the file was read with {} triangles instead of {}", case_.name,
                                   imported.mesh.triangles.size(), triangles_));
    }
    return std::make_shared<const TriangleMesh>(std::move(imported.mesh));
}

bool LoadMeasurer::time_all(std::vector<std::vector<double>>& builds) {
    progress_.threads = 1;
    if (!announce("reading")) return false;
    const std::shared_ptr<const TriangleMesh> mesh = time_reading();
    for (std::size_t k = 0; k < plan_.threads.size(); ++k) {
        const ThreadLimit limit(plan_.threads[k]);
        progress_.threads = thread_count();
        if (threads_.size() == k) threads_.push_back(progress_.threads);
        if (!announce("building")) return false;
        std::vector<ColliderDescription> colliders{{"ground", MeshShape{mesh, {}, ""}, 0}};
        std::unique_ptr<CollisionWorld> world;
        builds[k].push_back(time_of([&] { world = std::make_unique<CollisionWorld>(std::move(colliders)); }));
    }
    return true;
}

std::vector<LoadRow> LoadMeasurer::rows(const std::vector<std::vector<double>>& builds) const {
    LoadRow row;
    row.name = case_.name;
    row.format = name_of(case_.form);
    row.triangles = triangles_;
    row.file_bytes = fs::file_size(file_);
    row.read_seconds = median(reads_);
    std::vector<LoadRow> rows;
    for (std::size_t k = 0; k < builds.size(); ++k) {
        row.threads = threads_[k];
        row.build_seconds = median(builds[k]);
        rows.push_back(row);
    }
    return rows;
}

}  // namespace

std::optional<std::vector<LoadRow>> measure_load(const LoadCase& c, const MeasurementPlan& plan, const Hook& hook) {
    return LoadMeasurer(c, plan, hook).run();
}

}  // namespace ricochet::bench
