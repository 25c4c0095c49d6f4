/// \file
/// The include graph of the source tree and the rules it has to keep. What may include what is in rules() and kDoors
/// of the .cpp file: ARCHITECTURE.md tells the same in words.
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
    std::string path;  ///< below the repository's root, with forward slashes
    std::vector<Include> includes;
};

/// The files to check, and which headers of the library are public (installed).
struct SourceTree {
    std::vector<SourceFile> files;         ///< in the order of their paths
    std::set<std::string> public_headers;  ///< paths below the root
};

/// The .h and .cpp files in src, tests, meshes and bench below root, and src/ricochet/public_headers.txt.
[[nodiscard]] SourceTree read_source_tree(const std::filesystem::path& root);

/// Every broken rule as "file:line: what is wrong", in the order of the files. Empty when the tree keeps them all:
/// no include goes to a higher layer or a sibling, third-party headers stand only in their door files, no public header
/// includes a third-party or a private one, every quoted include names a file.
[[nodiscard]] std::vector<std::string> broken_rules(const SourceTree& tree);

/// Public headers that the umbrella header ricochet.h does not include.
[[nodiscard]] std::vector<std::string> missing_from_umbrella(const SourceTree& tree);

}  // namespace ricochet::layers
