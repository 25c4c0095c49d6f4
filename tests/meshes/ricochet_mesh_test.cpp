// Runs the program as a user does.
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <sys/wait.h>

#include <gtest/gtest.h>

namespace RICOCHET_FILE {

struct Outcome {
    int exit_code = -1;
    std::string text;  // stdout and stderr
};

Outcome run(const std::string& arguments) {
    const std::string command = std::string(RICOCHET_MESH_PROGRAM) + " " + arguments + " 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return {};
    Outcome outcome;
    std::array<char, 4096> buffer{};
    for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
        outcome.text.append(buffer.data(), n);
    const int status = pclose(pipe);
    outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
}

std::string content(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

class RicochetMesh : public testing::Test {
protected:
    void SetUp() override {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() / (std::string("ricochet_mesh_test_") + test->name());
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_;
};

TEST_F(RicochetMesh, ListsItsShapes) {
    const Outcome outcome = run("list");
    EXPECT_EQ(outcome.exit_code, 0);
    for (const char* kind : {"terrain", "rock", "cavity", "bowl", "funnel", "staircase", "torus-knot", "gear",
                             "galton-board", "drum", "fish", "box", "icosphere", "plate", "wedge"}) {
        EXPECT_NE(outcome.text.find(kind), std::string::npos) << kind;
    }
}

TEST_F(RicochetMesh, WritesEveryFormat) {
    for (const char* extension : {".obj", ".ply", ".stl", ".off"}) {
        const std::filesystem::path file = folder_ / (std::string("rock") + extension);
        const Outcome outcome = run("rock --triangles 500 --output " + file.string());
        EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
        EXPECT_GT(std::filesystem::file_size(file), 1000U);
    }
}

TEST_F(RicochetMesh, SameSeedWritesTheSameBytesAndAnotherSeedOthers) {
    for (const char* kind : {"rock", "terrain", "cavity"}) {
        const auto make = [&](const std::string& name, int seed) {
            const std::filesystem::path file = folder_ / name;
            EXPECT_EQ(run(std::string(kind) + " --triangles 2000 --seed " + std::to_string(seed) + " --output " +
                          file.string())
                          .exit_code,
                      0);
            return content(file);
        };
        EXPECT_EQ(make("a.ply", 3), make("b.ply", 3)) << kind;
        EXPECT_NE(make("a.ply", 3), make("c.ply", 4)) << kind;
    }
}

TEST_F(RicochetMesh, CommittedMeshesAreReproducedBitForBit) {
    const std::filesystem::path meshes = std::filesystem::path(RICOCHET_SOURCE_DIR) / "meshes";
    std::ifstream recipes(meshes / "recipes.txt");
    int checked = 0;
    for (std::string line; std::getline(recipes, line);) {
        if (line.empty() || line.front() == '#') continue;
        const std::size_t split = line.find(' ');
        const std::string name = line.substr(0, split);
        if (name.rfind("generated/", 0) == 0) continue;  // made by the build, not committed
        const std::filesystem::path made = folder_ / name;
        std::filesystem::create_directories(made.parent_path());
        const Outcome outcome = run(line.substr(split + 1) + " --output " + made.string());
        ASSERT_EQ(outcome.exit_code, 0) << line << '\n' << outcome.text;
        EXPECT_TRUE(content(made) == content(meshes / name)) << name << " differs from the mesh that its recipe makes";
        ++checked;
    }
    EXPECT_GE(checked, 9);
}

TEST_F(RicochetMesh, ReadmeListsEveryRecipe) {
    const std::filesystem::path meshes = std::filesystem::path(RICOCHET_SOURCE_DIR) / "meshes";
    const std::string readme = content(meshes / "README.md");
    std::ifstream recipes(meshes / "recipes.txt");
    for (std::string line; std::getline(recipes, line);) {
        if (line.empty() || line.front() == '#') continue;
        const std::size_t split = line.find(' ');
        const std::string row = "| `" + line.substr(0, split) + "` | `" + line.substr(split + 1) + "` |";
        EXPECT_NE(readme.find(row), std::string::npos) << row;
    }
}

void expect_refused(const std::string& arguments, const std::string& reason) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_EQ(outcome.text.rfind("ricochet-mesh: ", 0), 0U) << outcome.text;
    EXPECT_EQ(outcome.text.find('\n'), outcome.text.size() - 1) << "not one line: " << outcome.text;
    EXPECT_NE(outcome.text.find(reason), std::string::npos) << outcome.text;
}

TEST_F(RicochetMesh, RefusesWrongArgumentsInOneLine) {
    const std::string output = " --output " + (folder_ / "x.obj").string();
    expect_refused("", "subcommand is required");
    expect_refused("pyramid" + output, "pyramid");
    expect_refused("rock", "--output");
    expect_refused("rock --radius -3" + output, "--radius must be between");
    expect_refused("rock --triangles 1" + output, "--triangles must be between");
    expect_refused("rock --triangles many" + output, "--triangles");
    expect_refused("rock --sead 3" + output, "--sead");
    expect_refused("torus-knot -p 2 -q 4" + output, "no common divisor");
    expect_refused("rock --output " + (folder_ / "x.xyz").string(), ".xyz");
    expect_refused("rock --triangles 100000 --decimals 1" + output, "--decimals");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "x.obj"));
}

TEST_F(RicochetMesh, UnwritableFileFailsWithOneLine) {
    const Outcome outcome = run("box --output " + (folder_ / "missing" / "x.obj").string());
    EXPECT_EQ(outcome.exit_code, 1) << outcome.text;
    EXPECT_EQ(outcome.text.find('\n'), outcome.text.size() - 1) << outcome.text;
}

}  // namespace RICOCHET_FILE
