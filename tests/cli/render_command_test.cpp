#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "ricochet/io/frames.h"
#include "run/example_frames.h"
#include "run/frame_writer.h"
#include "run/run_folder.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::ProgramResult;
using test::run_ricochet;
using test::TemporaryFolder;

// Folder of an interrupted run: three frames, a mesh, and no run.json.
struct RunFolderFiles {
    TemporaryFolder folder;

    RunFolderFiles() {
        write_vtp(folder.path(collider_file_name(0, "block")),
                  mesh_collider_frame(test::example_mesh(), test::example_totals(), 0.0));
        FrameWriter writer(folder.path(""));
        for (const std::uint64_t step : {0U, 5U, 10U}) {
            Particles particles = test::example_particles(40);
            for (double& radius : particles.radius) radius = 0.5;  // large enough for tiny pictures
            writer.submit(step, particle_frame(particles, 0.1 * static_cast<double>(step)));
        }
        writer.finish();
    }
    [[nodiscard]] std::string path(const std::string& name) const { return folder.path(name).string(); }
    [[nodiscard]] bool exists(const std::string& name) const { return std::filesystem::exists(folder.path(name)); }
    [[nodiscard]] ProgramResult render(const std::string& output, std::vector<std::string> more = {}) const {
        const auto has = [&](const char* option) { return std::find(more.begin(), more.end(), option) != more.end(); };
        if (!has("--size")) more.insert(more.end(), {"--size", "48x32"});
        if (!has("--samples") && !has("--preview")) more.insert(more.end(), {"--samples", "1"});
        more.insert(more.begin(), {"render", path(""), "--output", path(output)});
        return run_ricochet(more);
    }
};

std::string png_size(const std::string& bytes) { return bytes.substr(16, 8); }

TEST(RenderCommand, DrawsTheLastFrameOrTheRequestedOne) {
    const RunFolderFiles files;
    EXPECT_EQ(files.render("last.png").exit_code, 0);
    EXPECT_EQ(files.render("ten.png", {"--frame", "10"}).exit_code, 0);
    const std::string png = files.folder.read("last.png");
    EXPECT_EQ(png.substr(1, 3), "PNG");
    EXPECT_EQ(png_size(png), std::string({0, 0, 0, 48, 0, 0, 0, 32}));
    EXPECT_TRUE(png == files.folder.read("ten.png"));
}

TEST(RenderCommand, NotesThatStreaksNeedAShutter) {
    const RunFolderFiles files;
    const ProgramResult closed = files.render("a.png", {"--draw", "streaks"});
    EXPECT_EQ(closed.exit_code, 0) << closed.errors;
    EXPECT_NE(closed.output.find("note: streaks need an open shutter"), std::string::npos) << closed.output;
    EXPECT_EQ(files.render("b.png", {"--draw", "streaks", "--shutter", "0.1"}).output.find("note:"), std::string::npos);
    EXPECT_EQ(files.render("c.png", {"--draw", "spheres"}).output.find("note:"), std::string::npos);
}

// At each time the picture must equal, bit for bit, the picture of a scene with the collider at that position.
TEST(RenderCommand, ShowsMovingCollidersAtTheirPositionInThatFrame) {
    const TemporaryFolder folder;
    const auto pictures = [&](const std::string& name, const std::string& placement) {
        const auto scene = folder.write(
            name + ".json", R"({"ricochet": 1, "simulation": {"time_step": 0.1, "duration": 1}, "output": {"every": 5},
            "colliders": [{"name": "floor", "type": "plane", "normal": [0, 0, 1]},
                          {"name": "box", "type": "box", "size": [0.5, 0.5, 0.5], )" +
                                placement + R"(}],
            "particles": [{"position": [0, 9, 9]}]})");
        const std::string output = folder.path(name).string();
        EXPECT_EQ(run_ricochet({"run", scene.string(), "--output", output, "--quiet"}).exit_code, 0);
        std::vector<std::string> seen;
        for (const char* frame : {"0", "10"}) {
            const ProgramResult result =
                run_ricochet({"render", output, "--frame", frame, "--output", folder.path("p.png").string(), "--size",
                              "96x64", "--samples", "1", "--camera", "0,-6,2,0,0,0.5,40"});
            EXPECT_EQ(result.exit_code, 0) << result.errors;
            seen.push_back(folder.read("p.png"));
        }
        return seen;
    };
    const auto moving = pictures("moving", R"("motion": [{"time": 0, "position": [-1, 0, 0.5]},
                                                         {"time": 1, "position": [1, 0, 0.5]}])");
    const auto left = pictures("left", R"("position": [-1, 0, 0.5])");
    const auto right = pictures("right", R"("position": [1, 0, 0.5])");
    EXPECT_TRUE(moving[0] == left[0]);
    EXPECT_TRUE(moving[1] == right[1]);
    EXPECT_TRUE(left[0] != right[1]);
}

TEST(RenderCommand, NumbersThePicturesOfAllFramesByTheirStep) {
    const RunFolderFiles files;
    EXPECT_EQ(files.render("p.png", {"--frame", "all", "--color-by", "contacts", "--color-map", "viridis"}).exit_code,
              0);
    for (const char* name : {"p_000000.png", "p_000005.png", "p_000010.png"}) EXPECT_TRUE(files.exists(name)) << name;
    EXPECT_FALSE(files.exists("p.png"));
}

TEST(RenderCommand, EveryOptionChangesThePicture) {
    const RunFolderFiles files;
    EXPECT_EQ(files.render("plain.png").exit_code, 0);
    const std::vector<std::vector<std::string>> options = {{"--camera", "5,5,5,0,0,0,60"},
                                                           {"--color-by", "mass"},
                                                           {"--color-map", "turbo"},
                                                           {"--range", "0.2,0.3"},
                                                           {"--collider-color", "hits"},
                                                           {"--particle-radius", "0.3"},
                                                           {"--size", "32x48"},
                                                           {"--exposure", "0.5"},
                                                           {"--up", "y"},
                                                           {"--light", "night"},
                                                           {"--background", "0,0.5,0"},
                                                           {"--background", "transparent"},
                                                           {"--ground", "auto"},
                                                           {"--lens", "2"},
                                                           {"--no-filter"},
                                                           {"--preview"},
                                                           {"--shutter", "0.3"},
                                                           {"--draw", "glow"},
                                                           {"--collider-color", "impulse/area"},
                                                           {"--hide", "collider_00_block"},
                                                           {"--glass", "collider_00_block"}};
    for (const auto& option : options) {
        const ProgramResult result = files.render("other.png", option);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        EXPECT_TRUE(files.folder.read("other.png") != files.folder.read("plain.png")) << option.front();
    }
}

TEST(RenderCommand, ADraftRefusesOptionsOfFinePictures) {
    const RunFolderFiles files;
    const std::vector<std::vector<std::string>> finer = {{"--samples", "16"}, {"--no-filter"}, {"--lens", "2"}};
    for (std::vector<std::string> options : finer) {
        const std::string name = options.front();
        options.emplace_back("--preview");
        const ProgramResult both = files.render("both.png", options);
        EXPECT_EQ(both.exit_code, 2);
        EXPECT_EQ(both.errors,
                  "ricochet: " + name +
                      ": found beside --preview, which has one ray a pixel, no noise and no blur, expected "
                      "one of them\n");
    }
}

TEST(RenderCommand, NightIsShortForTheLightOfNight) {
    const RunFolderFiles files;
    EXPECT_EQ(files.render("short.png", {"--night"}).exit_code, 0);
    EXPECT_EQ(files.render("long.png", {"--light", "night"}).exit_code, 0);
    EXPECT_TRUE(files.folder.read("short.png") == files.folder.read("long.png"));
    const ProgramResult both = files.render("both.png", {"--night", "--light", "noon"});
    EXPECT_EQ(both.exit_code, 2);
    EXPECT_EQ(both.errors, "ricochet: --night: found beside --light, expected one of them\n");
}

TEST(RenderCommand, ThePictureDoesNotDependOnThreads) {
    const RunFolderFiles files;
    EXPECT_EQ(files.render("one.png", {"--threads", "1"}).exit_code, 0);
    EXPECT_EQ(files.render("seven.png", {"--threads", "7"}).exit_code, 0);
    EXPECT_TRUE(files.folder.read("one.png") == files.folder.read("seven.png"));
}

/// Wrong arguments of `render`, with a part of the expected message.
struct Wrong {
    std::vector<std::string> arguments;
    const char* message;
};

const std::vector<Wrong> kWrongs = {
    {{"--frame", "7"}, "no such frame"},
    {{"--frame", "first"}, "expected a step number, last or all"},
    {{"--frame", "-1"}, "expected a step number"},
    {{"--ground", "5m"}, "--ground 5m: expected none, auto, or a height in m"},
    {{"--ground", "1,2"}, "expected none, auto, or a height in m"},
    {{"--frames", "3"}, "did you mean \"--frame\"?"},
    {{"--size", "0x10"}, "expected WIDTHxHEIGHT"},
    {{"--size", "640"}, "expected WIDTHxHEIGHT"},
    {{"--size", "99999x99999"}, "expected WIDTHxHEIGHT"},
    {{"--camera", "1,2,3"}, "expected px,py,pz,tx,ty,tz"},
    {{"--camera", "1,2,3,1,2,3"}, "position and target are the same"},
    {{"--camera", "1,2,3,0,0,nan"}, "expected numbers"},
    {{"--camera", "1,2,3,0,0,0,180"}, "field of view"},
    {{"--color-by", "temperature"}, "known arrays: speed, id, velocity, mass, radius"},
    {{"--color-map", "jet"}, "expected one of viridis, plasma, turbo"},
    {{"--range", "3,1"}, "low < high"},
    {{"--range", "a,b"}, "expected numbers"},
    {{"--collider-color", "pink"}, "expected plain or hits"},
    {{"--collider-color", "energy"}, "no contact log"},
    {{"--collider-color", "hits/mass"}, "expected plain or hits"},
    {{"--collider-range", "2,1"}, "low < high"},
    {{"--light", "dawn"}, "expected one of day, noon, overcast, night, studio"},
    {{"--background", "red"}, "expected sky, transparent"},
    {{"--background", "1,2,3"}, "expected sky, transparent"},
    {{"--ground", "low"}, "expected none, auto, or a height in m"},
    {{"--lens", "-1"}, "expected diameter[,distance]"},
    {{"--draw", "stars"}, "expected auto, spheres, streaks"},
    {{"--shutter", "-2"}, "expected 0 to"},
    {{"--speed", "0"}, "expected 1e-06 to"},
    {{"--hide", "nothing"}, "no such collider"},
    {{"--glass", "nothing"}, "--glass nothing: no such collider"},
    {{"--hide", "nothing", "--glass", "nothing"}, "expected one of them"},
    {{"--up", "w"}, "expected x, y or z"},
    {{"--samples", "0"}, "expected 1 to 4096"},
    {{"--exposure", "0"}, "expected 0.01 to 100"},
    {{"--particle-radius", "-1"}, "expected 0 to"},
    {{"--threads", "0"}, "expected a whole number"},
    {{"--fps", "0"}, "expected 1 to 240"},
    {{"--fps", "24"}, "expected a film"},
    {{"--speed", "2"}, "expected a film"},
    {{"--unknown"}, "--unknown"},
};

TEST(RenderCommand, RefusesWrongArgumentsInOneLineWithTheExpectedValues) {
    const RunFolderFiles files;
    for (const Wrong& wrong : kWrongs) {
        SCOPED_TRACE(wrong.arguments.front() + " " + wrong.arguments.back());
        std::vector<std::string> arguments = wrong.arguments;
        const bool own_size = arguments.front() == "--size" || arguments.front() == "--samples";
        arguments.insert(arguments.begin(), {"render", files.path(""), "--output", files.path("a.png")});
        if (!own_size) arguments.insert(arguments.end(), {"--size", "48x32"});
        const ProgramResult result = run_ricochet(arguments);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
        EXPECT_NE(result.errors.find(wrong.message), std::string::npos) << result.errors;
        EXPECT_FALSE(files.exists("a.png"));
    }
}

TEST(RenderCommand, RefusesWrongFoldersAndNames) {
    const RunFolderFiles files;
    const TemporaryFolder empty;
    EXPECT_EQ(files.render("a.jpg").exit_code, 2);
    EXPECT_EQ(files.render("none/a.png").exit_code, 1);
    EXPECT_EQ(run_ricochet({"render", files.path("none"), "--output", files.path("a.png")}).exit_code, 2);
    EXPECT_EQ(run_ricochet({"render", empty.path("").string(), "--output", files.path("a.png")}).exit_code, 2);
    (void)files.folder.write("particles_000010.vtp", "no longer a frame");
    const ProgramResult damaged = files.render("a.png");
    EXPECT_EQ(damaged.exit_code, 2);
    EXPECT_NE(damaged.errors.find("particles_000010.vtp"), std::string::npos) << damaged.errors;
}

TEST(RenderCommand, MakesAFilmWithFfmpegAndNothingWithoutIt) {
    const RunFolderFiles files;
    EXPECT_EQ(files.render("odd.mp4", {"--size", "47x32"}).exit_code, 2);
    const std::string path = std::getenv("PATH");
    ASSERT_EQ(::setenv("PATH", files.path("no/programs").c_str(), 1), 0);
    const ProgramResult without = files.render("film.mp4");
    ASSERT_EQ(::setenv("PATH", path.c_str(), 1), 0);
    EXPECT_EQ(without.exit_code, 1);
    EXPECT_NE(without.errors.find("install ffmpeg"), std::string::npos) << without.errors;
    EXPECT_FALSE(files.exists("film.mp4"));
    if (std::system("command -v ffmpeg > /dev/null") != 0) GTEST_SKIP() << "ffmpeg is not installed";
    const ProgramResult with = files.render("film.mp4");
    EXPECT_EQ(with.exit_code, 0) << with.errors;
    EXPECT_EQ(files.folder.read("film.mp4").substr(4, 4), "ftyp");
    for (const auto& entry : std::filesystem::directory_iterator(files.folder.path(""))) {
        EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();
    }
}

/// Returns a prefix that limits the size of files, in KiB. To the program this looks like a full disk.
test::ProgramStart with_room_for(int kibibytes) {
    test::ProgramStart start;
    start.prefix = {"bash", "-c", "ulimit -f " + std::to_string(kibibytes) + "; exec \"$@\"", "bash"};
    return start;
}

TEST(RenderCommand, AFilmOnAFullDiskEndsWithOneLineAndWithoutAFile) {
    if (std::system("command -v ffmpeg > /dev/null") != 0) GTEST_SKIP() << "ffmpeg is not installed";
    const RunFolderFiles files;
    const std::vector<std::string> film{"render",  files.path(""), "--output",  files.path("film.mp4"),
                                        "--size",  "160x120",      "--samples", "1",
                                        "--quiet", "--threads",    "1"};
    ASSERT_EQ(run_ricochet(film).exit_code, 0);
    const int whole = static_cast<int>(files.folder.read("film.mp4").size() / 1024);
    ASSERT_GT(whole, 2);
    std::filesystem::remove(files.folder.path("film.mp4"));
    for (const int room : {1, whole / 2, whole}) {
        SCOPED_TRACE(room);
        const ProgramResult full = run_ricochet(film, with_room_for(room));
        EXPECT_EQ(full.exit_code, 1);
        EXPECT_NE(full.errors.find("film.mp4: ffmpeg failed"), std::string::npos) << full.errors;
        EXPECT_EQ(std::count(full.errors.begin(), full.errors.end(), '\n'), 1) << full.errors;
        EXPECT_FALSE(files.exists("film.mp4"));
    }
}

// The imitated encoder stops early and returns success.
TEST(RenderCommand, AnUnfinishedFilmGetsNoFinalName) {
    const RunFolderFiles files;
    const std::string bytes = std::string("\0\0\0\x18", 4) + "ftypisom" + std::string(12, '\0');
    (void)files.folder.write("start", bytes + std::string("\0\0\1\0", 4) + "mdat");
    std::filesystem::create_directory(files.folder.path("bin"));
    (void)files.folder.write("bin/ffmpeg", "#!/bin/sh\ncat > /dev/null\nfor last; do :; done\ncat '" +
                                               files.path("start") + "' > \"${last#file:}\"\n");
    std::filesystem::permissions(files.folder.path("bin/ffmpeg"), std::filesystem::perms::owner_all);
    test::ProgramStart start;
    start.environment = {"PATH=" + files.path("bin") + ":" + std::getenv("PATH")};
    const ProgramResult broken = run_ricochet(
        {"render", files.path(""), "--output", files.path("film.mp4"), "--size", "48x32", "--samples", "1", "--quiet"},
        start);
    EXPECT_EQ(broken.exit_code, 1);
    EXPECT_NE(broken.errors.find("film.mp4: ffmpeg failed"), std::string::npos) << broken.errors;
    EXPECT_FALSE(files.exists("film.mp4"));
}

// The time and the radius in a scene have the same effect as the options. Options take precedence.
TEST(RenderCommand, PicturesFollowTheSettingsOfTheScene) {
    const TemporaryFolder folder;
    const auto run = [&](const std::string& name, const std::string& picture) {
        const auto scene = folder.write(name + ".json", R"({"ricochet": 1,
            "simulation": {"time_step": 0.1, "duration": 1}, "output": {"every": 2},
            "colliders": [{"name": "floor", "type": "plane", "normal": [0, 0, 1]},
                          {"name": "box", "type": "box", "size": [1, 1, 1], "position": [0, 0, 0.5]}],
            "particles": [{"position": [0.3, 0, 1.5], "velocity": [1, 0, -1]}, {"position": [-1, 0, 1e-9]}],
            "camera": {"position": [0, -5, 2], "target": [0, 0, 0.5]}, "picture": )" +
                                                            picture + "}");
        const ProgramResult result =
            run_ricochet({"run", scene.string(), "--output", folder.path(name).string(), "--quiet"});
        EXPECT_EQ(result.exit_code, 0) << result.errors;
    };
    const auto picture = [&](const std::string& name, std::vector<std::string> more) {
        const std::string output = folder.path("picture.png").string();
        more.insert(more.begin(), {"render", folder.path(name).string(), "--output", output, "--size", "96x64",
                                   "--samples", "1", "--quiet"});
        const ProgramResult result = run_ricochet(more);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return folder.read("picture.png");
    };
    run("plain", "{}");
    run("told", R"({"time": 0.43, "particle_radius": 0.2, "light": "night"})");
    const std::string told = picture("told", {});
    EXPECT_TRUE(told == picture("plain", {"--frame", "4", "--particle-radius", "0.2", "--light", "night"}));
    EXPECT_FALSE(told == picture("plain", {"--particle-radius", "0.2", "--light", "night"}));
    EXPECT_TRUE(picture("told", {"--frame", "last", "--particle-radius", "0", "--light", "day"}) ==
                picture("plain", {}));
}

// The points lie on the floor, and the camera is below it. The balls must stay on the other side of the floor.
TEST(RenderCommand, LargeBallsDoNotPokeThroughWalls) {
    const TemporaryFolder folder;
    std::vector<std::string> pictures;
    for (const char* particle : {R"({"position": [0, 0, 1.0000000001]})", R"({"position": [0, 0, 40]})"}) {
        const auto scene = folder.write("s.json", std::string(R"({"ricochet": 1,
            "simulation": {"time_step": 0.1, "duration": 0.1},
            "colliders": [{"name": "box", "type": "box", "size": [2, 2, 2]}],
            "camera": {"position": [0, 0, 0.3], "target": [0, 0, 1], "up": [0, 1, 0], "field_of_view": 60},
            "picture": {"particle_radius": 0.3}, "particles": [)") +
                                                      particle + "]}");
        ASSERT_EQ(run_ricochet({"run", scene.string(), "--output", folder.path("run").string(), "--quiet"}).exit_code,
                  0);
        const std::string output = folder.path("picture.png").string();
        ASSERT_EQ(run_ricochet(
                      {"render", folder.path("run").string(), "--output", output, "--size", "64x64", "--samples", "1"})
                      .exit_code,
                  0);
        pictures.push_back(folder.read("picture.png"));
    }
    EXPECT_TRUE(pictures[0] == pictures[1]);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
