// Types of the same name in the same namespace must not have two definitions. If two headers define one, no source file
// needs to include both: the linker then merges functions for the two types, which have different sizes.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet::layers {
namespace RICOCHET_FILE {

/// Returns the name of the type that a line at the left margin defines; empty without one.
std::string defined_type(std::string_view line) {
    for (const std::string_view keyword : {"struct ", "class ", "enum class ", "enum ", "union "}) {
        if (!line.starts_with(keyword) || line.ends_with(";")) continue;
        std::string_view rest = line.substr(keyword.size());
        for (const std::string_view attribute : {"__attribute__((", "alignas("}) {
            if (rest.starts_with(attribute)) rest.remove_prefix(rest.find(") ") + 2);
        }
        return std::string(rest.substr(0, rest.find_first_of(" {<")));
    }
    return {};
}

/// Returns the headers below a folder that define each type, by the type's full name.
std::map<std::string, std::set<std::string>> types_below(const std::filesystem::path& folder) {
    std::map<std::string, std::set<std::string>> types;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".h") continue;
        std::ifstream file(entry.path());
        std::vector<std::string> scopes;
        for (std::string line; std::getline(file, line);) {
            if (line.starts_with("namespace ") && line.ends_with("{")) {
                scopes.push_back(line.substr(10, line.size() - 12));
            } else if (line.starts_with("}  // namespace") && !scopes.empty()) {
                scopes.pop_back();
            } else if (const std::string type = defined_type(line); !type.empty()) {
                std::string name;
                for (const std::string& scope : scopes) name += scope + "::";
                types[name + type].insert(entry.path().lexically_relative(folder).generic_string());
            }
        }
    }
    return types;
}

std::vector<std::string> defined_twice(const std::filesystem::path& folder) {
    std::vector<std::string> found;
    for (const auto& [name, headers] : types_below(folder)) {
        if (headers.size() < 2) continue;
        std::string line = name + ":";
        for (const std::string& header : headers) line += " " + header;
        found.push_back(line);
    }
    return found;
}

TEST(TypeNames, AreDefinedInOneHeaderEach) {
    const std::filesystem::path source = std::filesystem::path(RICOCHET_SOURCE_DIR) / "src";
    EXPECT_GT(types_below(source).size(), 500U);
    EXPECT_EQ(defined_twice(source), std::vector<std::string>{});
}

TEST(TypeNames, SecondDefinitionIsReported) {
    const std::filesystem::path root = std::filesystem::path(testing::TempDir()) / "ricochet_type_names";
    std::filesystem::create_directories(root / "view");
    std::ofstream(root / "a.h") << "namespace ricochet {\nstruct Point {\n};\nclass Other;\n}  // namespace ricochet\n";
    std::ofstream(root / "view/b.h") << "namespace ricochet {\n\nclass Point final\n    : public Base {\n};\n"
                                        "class Other {\n};\n}  // namespace ricochet\n";
    std::ofstream(root / "c.h") << "namespace ricochet::mesh {\nstruct Point {\n};\n}  // namespace ricochet::mesh\n";
    const std::vector<std::string> found = defined_twice(root);
    std::filesystem::remove_all(root);
    EXPECT_EQ(found, std::vector<std::string>{"ricochet::Point: a.h view/b.h"});
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::layers
