/// \file
/// The include graph of the source tree and the rules for it. The tables allowed_layers() and kDoors of the .cpp file
/// list the allowed includes; ARCHITECTURE.md describes them in words.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace ricochet::layers {

/// One #include line.
struct Include {
    int line = 0;
    std::string name;  ///< as written, without quotes or brackets
};

/// One header or source file.
struct SourceFile {
    std::string path;  ///< relative to the repository's root, with forward slashes
    std::vector<Include> includes;
};

/// The files to check, and the set of public (installed) headers of the library.
struct SourceTree {
    std::vector<SourceFile> files;         ///< sorted by path
    std::set<std::string> public_headers;  ///< paths relative to the root
};

/// Reads the .h and .cpp files in src, tests, meshes and bench below root, and src/ricochet/public_headers.txt.
[[nodiscard]] SourceTree read_source_tree(const std::filesystem::path& root);

/// Returns every broken rule as "file:line: reason", in the order of the files; empty if all rules are kept. The rules:
/// - No include goes to a higher layer or a sibling.
/// - Third-party headers are included only by their door files.
/// - No public header includes a third-party or a private header.
/// - Every quoted include names a file.
[[nodiscard]] std::vector<std::string> broken_rules(const SourceTree& tree);

/// Returns the public headers that the umbrella header ricochet.h does not include.
[[nodiscard]] std::vector<std::string> missing_from_umbrella(const SourceTree& tree);

}  // namespace ricochet::layers
