#include "layers/include_graph.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <optional>
#include <regex>

namespace ricochet::layers {
namespace {

namespace fs = std::filesystem;

const std::string kUmbrella = "src/ricochet/ricochet.h";
const std::string kLibrary = "src/ricochet/";

/// Returns the layers that each layer of the library may include besides itself.
const std::map<std::string, std::set<std::string>>& allowed_layers() {
    static const std::map<std::string, std::set<std::string>> table = {
        {"core", {}},
        {"geometry", {"core"}},
        {"queries", {"core", "geometry"}},
        {"collision", {"core", "geometry"}},
        {"dynamics", {"core", "geometry"}},
        {"response", {"core", "geometry", "collision", "dynamics"}},
        {"verify", {"core", "geometry"}},  // limited further by may_verify()
        {"simulation", {"core", "geometry", "collision", "dynamics", "response", "verify"}},
        {"io", {"core", "geometry", "collision", "dynamics", "response", "verify", "simulation"}},
        {"inspect", {"core", "geometry", "collision", "dynamics", "response", "simulation", "io"}},
        {"run", {"core", "geometry", "collision", "dynamics", "response", "verify", "simulation", "io"}},
        // view: pictures, files of other formats, pages
        {"render", {"core", "geometry", "collision", "dynamics", "response", "verify", "simulation", "run"}},
        {"export", {"core", "geometry", "collision", "dynamics", "response", "verify", "simulation", "io", "run"}},
        {"page", {"core", "geometry", "dynamics", "io", "run", "render", "export"}},
        // lab: measurements
        {"compare", {"core", "geometry", "collision", "dynamics", "response", "verify", "simulation", "io", "run"}},
        {"generators", {"core", "geometry"}},  // the library of the mesh generator
        {"bench", {"core", "geometry", "collision", "dynamics", "response", "simulation", "run", "generators"}},
        {"study", {"core", "run", "compare"}},
        {"mpi", {"core"}},
        {"python",
         {"core", "geometry", "queries", "collision", "dynamics", "response", "simulation", "io", "run", "inspect",
          "render"}},
        {"cli",
         {"core", "geometry", "queries", "collision", "dynamics", "response", "verify", "simulation", "io", "run",
          "inspect", "render", "export", "page", "compare", "bench", "study", "mpi"}},
    };
    return table;
}

/// Returns true if the verifier may include the header. The verifier checks the sweep, so it must not compute with the
/// sweep's code. It may include plain data only, and the headers that describe the frames of a scene.
bool may_verify(const std::string& header) {
    static const std::set<std::string> plain = {
        "core/box3.h",
        "core/error.h",
        "core/frame_tree.h",
        "core/motion_part.h",
        "core/pair_meeting.h",
        "core/segment.h",
        "core/vec3.h",
        "core/tolerances.h",
        "core/transform.h",
        "geometry/mesh/triangle_mesh.h",
        "core/recorded_impact.h",
    };
    return plain.contains(header.substr(kLibrary.size()));
}

/// A third-party library: the start of its headers, and a regular expression for the files that may include them.
struct Door {
    const char* headers;
    const char* files;
};

/// All libraries besides our own and the C++ standard library.
constexpr std::array kDoors = {
    Door{"embree[34]/", "src/ricochet/geometry/acceleration/embree\\.h"},
    Door{"ricochet/geometry/acceleration/embree\\.h",
         "src/ricochet/geometry/acceleration/triangle_bvh\\.cpp|src/view/render/(preview_impl\\.h|drawn_mesh\\.h|"
         "shape_copies\\.h)|src/lab/bench/native_ray\\.h"},
    Door{"OpenMesh/", "src/inspect/mesh_topology\\.cpp"},
    Door{"assimp/", "src/ricochet/geometry/mesh/assimp_reader\\.cpp"},
    Door{"(oneapi/)?tbb/", "src/ricochet/core/parallel\\.cpp|tests/core/parallel_test\\.cpp"},
    Door{"nlohmann/",
         "src/(run|inspect|view/export|view/page|lab|cli)/.*\\.cpp|src/ricochet/core/json_document\\.cpp|tests/.*"},
    Door{"CLI/", "src/cli/command_line\\.cpp"},
    Door{"fmt/", ".*\\.cpp|src/cli/terminal\\.h"},  // the print() of this header checks formats as fmt does
    Door{"stb/", "src/view/render/image\\.cpp|tests/view/render/image_test\\.cpp"},
    Door{"zlib\\.h", "src/view/page/packing\\.cpp|tests/view/page/.*\\.cpp"},
    Door{"(mpi|sched)\\.h", "src/mpi/mpi_ranks\\.cpp"},
    Door{"(gtest|gmock)/", "tests/.*"},
    Door{"benchmark/", "bench/.*"},
    Door{"(pybind11/|Python\\.h)", "src/python/.*"},
    Door{"Eigen/", "src/ricochet/dynamics/(block_cholesky|implicit_(matrix|system))\\.(cpp|h)"},
    Door{"boost/", "src/ricochet/verify/[^/]*\\.cpp|src/ricochet/geometry/predicates/exact_ratio\\.cpp|tests/.*"},
    Door{"(unistd|fcntl|signal|spawn|malloc)\\.h|sys/", ".*\\.cpp|tests/.*"},
    Door{"dlfcn\\.h", "src/mpi/load_mpi\\.cpp|tests/.*"},
    Door{"(poll|time|ucontext)\\.h|linux/", "tests/.*"},
};

bool matches(const std::string& text, const std::string& pattern) {
    return std::regex_match(text, std::regex(pattern));
}

/// Returns the layer of a file of the library, the tool, or the parts of the tool; nothing for other files and the
/// umbrella header.
std::optional<std::string> layer_of(const std::string& path) {
    if (path == kUmbrella) return std::nullopt;
    if (path.starts_with("src/cli/")) return "cli";
    if (path.starts_with("src/mpi/")) return "mpi";
    if (path.starts_with("src/python/")) return "python";
    if (path.starts_with("src/inspect/")) return "inspect";
    if (path.starts_with("src/run/")) return "run";
    for (const std::string product : {"src/view/", "src/lab/"}) {
        if (path.starts_with(product))
            return path.substr(product.size(), path.find('/', product.size()) - product.size());
    }
    if (path.starts_with("meshes/generators/")) return "generators";
    if (!path.starts_with(kLibrary)) return std::nullopt;
    const std::string below = path.substr(kLibrary.size());
    const std::size_t slash = below.find('/');
    return slash == std::string::npos ? "simulation" : below.substr(0, slash);
}

bool is_header(const std::string& path) { return path.ends_with(".h"); }

/// Returns true if an installation contains the header.
bool is_public_header(const SourceTree& tree, const std::string& path) { return tree.public_headers.contains(path); }

/// Returns true if the path is a private header of the library.
bool is_private(const SourceTree& tree, const std::string& path) {
    return is_header(path) && path.starts_with(kLibrary) && !is_public_header(tree, path);
}

/// Returns the file of the tree that an include line names; nothing for third-party headers.
std::optional<std::string> resolve(const std::set<std::string>& paths, const SourceFile& from,
                                   const std::string& name) {
    const std::string beside = from.path.substr(0, from.path.rfind('/') + 1) + name;
    for (const std::string& candidate : {"src/" + name, "tests/" + name, "meshes/" + name, beside}) {
        if (paths.contains(candidate)) return candidate;
    }
    return std::nullopt;
}

std::vector<Include> read_includes(const fs::path& file) {
    static const std::regex pattern(R"re(^\s*#\s*include\s*["<]([^">]+)[">].*)re");
    std::vector<Include> includes;
    std::ifstream stream(file);
    std::string text;
    for (int line = 1; std::getline(stream, text); ++line) {
        std::smatch match;
        if (std::regex_match(text, match, pattern)) includes.push_back({line, match[1]});
    }
    return includes;
}

std::set<std::string> read_public_headers(const fs::path& root) {
    std::set<std::string> headers;
    std::ifstream stream(root / kLibrary / "public_headers.txt");
    std::string text;
    while (std::getline(stream, text)) {
        if (!text.empty() && !text.starts_with('#')) headers.insert(kLibrary + text);
    }
    return headers;
}

/// Returns the reason why a file must not include one of our own files; nothing if it may.
std::optional<std::string> wrong_layer(const SourceTree& tree, const SourceFile& from, const std::string& target) {
    const auto layer = layer_of(from.path);
    if (is_public_header(tree, from.path) && is_private(tree, target)) {
        return "a public header includes the private header " + target;
    }
    if (!layer) return std::nullopt;
    const auto row = allowed_layers().find(*layer);
    if (row == allowed_layers().end()) return "the folder " + *layer + " is no layer";
    const auto below = layer_of(target);
    if (!below) return "the library includes " + target + ", which stands outside its layers";
    if (*layer == "verify" && *below != "verify" && row->second.contains(*below) && !may_verify(target)) {
        return "verify must be independent of " + target;
    }
    if (*below == *layer || row->second.contains(*below)) return std::nullopt;
    return *layer + " must not include " + *below + " (" + target + ")";
}

/// Returns the reason why a file must not include a third-party header; nothing if it may.
std::optional<std::string> wrong_door(const SourceTree& tree, const SourceFile& from, const std::string& name) {
    const auto door = std::find_if(kDoors.begin(), kDoors.end(),
                                   [&](const Door& d) { return matches(name, std::string("(") + d.headers + ").*"); });
    if (door == kDoors.end()) return std::nullopt;
    if (is_public_header(tree, from.path)) return "a public header includes the third-party header " + name;
    if (matches(from.path, door->files)) return std::nullopt;
    return name + " may be included only in " + door->files;
}

bool is_standard(const std::string& name) { return name.find_first_of("./") == std::string::npos; }

std::optional<std::string> wrong(const SourceTree& tree, const std::set<std::string>& paths, const SourceFile& from,
                                 const std::string& name) {
    if (auto reason = wrong_door(tree, from, name)) return reason;
    if (const auto target = resolve(paths, from, name)) return wrong_layer(tree, from, *target);
    const bool behind_a_door = std::any_of(kDoors.begin(), kDoors.end(), [&](const Door& d) {
        return matches(name, std::string("(") + d.headers + ").*");
    });
    if (is_standard(name) || behind_a_door) return std::nullopt;
    return name + " is neither a file of this project nor of a library that it knows";
}

}  // namespace

SourceTree read_source_tree(const fs::path& root) {
    SourceTree tree;
    tree.public_headers = read_public_headers(root);
    for (const char* folder : {"src", "tests", "meshes", "bench"}) {
        if (!fs::is_directory(root / folder)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
            const auto extension = entry.path().extension();
            if (extension != ".h" && extension != ".cpp") continue;
            tree.files.push_back({fs::relative(entry.path(), root).generic_string(), read_includes(entry.path())});
        }
    }
    std::sort(tree.files.begin(), tree.files.end(),
              [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
    return tree;
}

std::vector<std::string> broken_rules(const SourceTree& tree) {
    std::set<std::string> paths;
    for (const SourceFile& file : tree.files) paths.insert(file.path);
    std::vector<std::string> broken;
    for (const SourceFile& file : tree.files) {
        for (const Include& include : file.includes) {
            if (const auto reason = wrong(tree, paths, file, include.name)) {
                broken.push_back(file.path + ":" + std::to_string(include.line) + ": " + *reason);
            }
        }
    }
    for (const std::string& header : tree.public_headers) {
        if (!paths.contains(header)) broken.push_back("public_headers.txt names " + header + ", which does not exist");
    }
    return broken;
}

std::vector<std::string> missing_from_umbrella(const SourceTree& tree) {
    std::set<std::string> included;
    for (const SourceFile& file : tree.files) {
        if (file.path != kUmbrella) continue;
        for (const Include& include : file.includes) included.insert("src/" + include.name);
    }
    std::vector<std::string> missing;
    for (const SourceFile& file : tree.files) {
        const bool wanted = is_public_header(tree, file.path) && file.path != kUmbrella;
        if (wanted && !included.contains(file.path)) missing.push_back(file.path);
    }
    return missing;
}

}  // namespace ricochet::layers
