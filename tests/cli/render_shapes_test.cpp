#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "support/temporary_folder.h"
#include "view/render/image.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::ProgramResult;
using test::run_ricochet;
using test::TemporaryFolder;

constexpr const char* kShard = "v 1 0 0\nv -1 0.5 0\nv -1 -0.5 0\nv 0 0 0.6\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 1 3 2\n";

// Fixture with a folder of runs.
class Shapes : public ::testing::Test {
protected:
    // Runs a scene and returns its output folder.
    [[nodiscard]] std::string run(const std::string& name, const std::string& keys) const {
        const auto scene = folder_.write(name + ".json", R"({"ricochet": 1,
            "simulation": {"time_step": 0.02, "duration": 0.4, "integrator": "ballistic"}, )" +
                                                             keys + "}");
        const std::string output = folder_.path(name).string();
        const ProgramResult result = run_ricochet({"run", scene.string(), "--output", output, "--quiet"});
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return output;
    }
    [[nodiscard]] ProgramResult render(const std::string& run, const std::string& output,
                                       std::vector<std::string> more = {}) const {
        more.insert(more.begin(),
                    {"render", run, "--output", folder_.path(output).string(), "--size", "96x64", "--samples", "2"});
        return run_ricochet(more);
    }
    // Returns the bytes of a picture that must succeed.
    [[nodiscard]] std::string picture(const std::string& run, std::vector<std::string> more = {}) const {
        const ProgramResult result = render(run, "p.png", std::move(more));
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return folder_.read("p.png");
    }
    // Returns the width and height of the visible objects before a transparent background, in pixels.
    [[nodiscard]] std::pair<int, int> extent(const std::string& run, std::vector<std::string> more) const {
        more.insert(more.end(), {"--background", "transparent", "--no-filter"});
        (void)picture(run, std::move(more));
        const Image image = read_png(folder_.path("p.png"));
        int left = image.width, right = -1, top = image.height, bottom = -1;
        for (int i = 0; i < image.width * image.height; ++i) {
            if (image.alpha[static_cast<std::size_t>(i)] == 0) continue;
            left = std::min(left, i % image.width);
            right = std::max(right, i % image.width);
            top = std::min(top, i / image.width);
            bottom = std::max(bottom, i / image.width);
        }
        return {right - left + 1, bottom - top + 1};
    }
    void SetUp() override {
        (void)folder_.write("shard.obj", kShard);
        write_png(folder_.path("white.png"), {2, 2, std::vector<std::uint8_t>(12, 255), {}});
        write_png(folder_.path("dot.png"), {2, 1, {255, 0, 0, 0, 255, 0}, {255, 128}});
    }
    [[nodiscard]] std::string path(const std::string& name) const { return folder_.path(name).string(); }

    TemporaryFolder folder_;
};

const std::string kBalls = R"("particles": [{"position": [0, 0, 0], "radius": 0.5, "spin": [1, 2, 3]},
    {"position": [3, 0, 1], "radius": 0.5}, {"position": [0, 0, 4], "velocity": [1, 0, 0]}])";

TEST_F(Shapes, SceneAndCommandLineDrawTheSameFromTheSameFiles) {
    const std::string plain = run("plain", kBalls);
    const std::string sprites =
        run("sprites", kBalls + R"(, "picture": {"particles": "sprites", "sprite": "dot.png"})");
    const std::string meshes = run("meshes", kBalls + R"(, "picture": {"particles": "meshes", "mesh": "shard.obj"})");
    const std::string spheres = picture(plain);
    const std::string dots = picture(sprites);
    const std::string shards = picture(meshes);
    EXPECT_TRUE(dots != spheres && shards != spheres && dots != shards);
    EXPECT_TRUE(picture(plain, {"--sprite", path("dot.png")}) == dots);
    EXPECT_TRUE(picture(plain, {"--mesh", path("shard.obj")}) == shards);
    std::filesystem::remove(folder_.path("dot.png"));
    EXPECT_TRUE(picture(sprites) == dots) << "the run must keep its own copy of the mesh";
    EXPECT_TRUE(picture(sprites, {"--draw", "spheres", "--camera", "9,-9,5,1,0,2"}) ==
                picture(plain, {"--camera", "9,-9,5,1,0,2"}));
}

TEST_F(Shapes, SpritesHaveTheColoursOfTheirImageUnlessOthersAreRequested) {
    const std::string balls = run("balls", kBalls);
    const ProgramResult own = render(balls, "own.png", {"--sprite", path("dot.png")});
    EXPECT_NE(own.output.find("in the colours of the sprite"), std::string::npos) << own.output;
    const ProgramResult mapped = render(balls, "mapped.png", {"--sprite", path("dot.png"), "--color-by", "speed"});
    EXPECT_NE(mapped.output.find("speed from"), std::string::npos) << mapped.output;
    EXPECT_TRUE(folder_.read("own.png") != folder_.read("mapped.png"));
}

TEST_F(Shapes, RefusesMissingAndUnsuitableFiles) {
    const std::string balls = run("balls", kBalls);
    (void)folder_.write("words.png", "words");
    (void)folder_.write("point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
    const std::vector<std::pair<std::vector<std::string>, std::string>> wrongs = {
        {{"--draw", "sprites"}, "expected --sprite FILE.png"},
        {{"--draw", "meshes"}, "expected --mesh FILE"},
        {{"--sprite", path("none.png")}, "none.png: cannot be read"},
        {{"--sprite", path("words.png")}, "words.png: is not a PNG file"},
        {{"--mesh", path("none.obj")}, "none.obj"},
        {{"--mesh", path("point.obj")}, "has no size"},
        {{"--mesh", path("shard.obj"), "--draw", "glow"}, "expected --draw meshes"},
        {{"--sprite", path("dot.png"), "--mesh", path("shard.obj")}, "found beside another --draw"}};
    for (const auto& [options, message] : wrongs) {
        const ProgramResult result = render(balls, "w.png", options);
        EXPECT_EQ(result.exit_code, 2) << message;
        EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
        EXPECT_NE(result.errors.find(message), std::string::npos) << result.errors;
    }
}

// The view is from the side, with 16 pixels per metre. A ball of radius 1 stretched by 1.6 is 1 / sqrt(1.6) as high.
TEST_F(Shapes, AStretchedBallHasALengthInProportionToItsSpeed) {
    const std::vector<std::string> side = {"--camera", "2,-10,0,2,0,0,22.6198649480404"};
    const std::string moving = R"("particles": [{"position": [0, 0, 0], "velocity": [5, 0, 0], "radius": 0.5}])";
    const auto at_rest = extent(run("plain", moving), side);
    EXPECT_NEAR(at_rest.first, 16, 1);
    EXPECT_NEAR(at_rest.second, 16, 1);
    const auto longer = extent(run("long", moving + R"(, "picture": {"stretch": {"speed": 0.12}})"), side);
    EXPECT_NEAR(longer.first, 16.0 * 1.6, 1.5);
    EXPECT_NEAR(longer.second, 16.0 / std::sqrt(1.6), 1.5);
    const auto most = extent(run("most", moving + R"(, "picture": {"stretch": {"speed": 9, "most": 2}})"), side);
    EXPECT_NEAR(most.first, 32.0, 1.5);
}

// The ball lands after 0.2 s at 5 m/s, in the step of a frame. It is then half as high and lies on the floor.
TEST_F(Shapes, ALandingBallIsFlatterAtItsImpact) {
    const std::string falls = R"("particles": [{"position": [0, 0, 1.5], "velocity": [0, 0, -5], "radius": 0.5}],
        "colliders": [{"name": "floor", "type": "plane", "normal": [0, 0, 1], "looks": {"hidden": true}}],
        "output": {"contacts": true}, "picture": {"stretch": {"impact": 0.2, "time": 0.1}})";
    const std::string output = run("falls", falls);
    const std::vector<std::string> side = {"--camera", "0,-10,0.5,0,0,0.5,22.6198649480404", "--frame"};
    const auto frame = [&](const char* step) {
        std::vector<std::string> options = side;
        options.emplace_back(step);
        return extent(output, options);
    };
    EXPECT_NEAR(frame("10").second, 8, 1.5);
    EXPECT_NEAR(frame("10").first, 16.0 * std::sqrt(2.0), 1.5);
    EXPECT_NEAR(frame("6").second, 16, 1);
    EXPECT_NEAR(frame("14").second, 16, 1);
}

// At night a particle at the reference temperature is brighter than the rest, and a particle at room temperature is
// dark.
TEST_F(Shapes, HotParticlesShineAsBlackBodies) {
    const std::string hot = R"("attributes": {"temperature": {"default": 1500}},
        "particles": [{"position": [-1, 0, 0], "velocity": [0, 0.5, 0], "radius": 0.5}, {"position": [1, 0, 0], "velocity": [0, 0.5, 0], "radius": 0.5,
                       "attributes": {"temperature": 300}}])";
    const std::string shines = run("shines", hot + R"(, "picture": {"light": "night", "black_body": 1500})");
    const std::string plain = run("plain", hot + R"(, "picture": {"light": "night"})");
    std::vector<std::string> view = {"--camera", "0,-6,0,0,0,0,40"};
    const std::string by_scene = picture(shines, view);
    const Image image = read_png(folder_.path("p.png"));
    const auto left = image.pixel(33, 32);
    const auto right = image.pixel(62, 32);
    EXPECT_GT(left[0], 200);
    EXPECT_GT(left[0], left[1] + 20);
    EXPECT_GT(left[1], left[2]);
    EXPECT_LT(right[0], 60);
    for (const char* drawing : {"spheres", "glow", "soft", "streaks"}) {
        std::vector<std::string> options = view;
        options.insert(options.end(), {"--draw", drawing, "--shutter", "0.1"});
        const std::string without = picture(plain, options);
        options.insert(options.end(), {"--black-body", "1500"});
        EXPECT_TRUE(picture(plain, options) != without) << drawing;
    }
    view.insert(view.end(), {"--black-body", "1500"});
    EXPECT_TRUE(picture(plain, view) == by_scene);
    const ProgramResult cold = render(run("cold", kBalls), "c.png", {"--black-body", "1500"});
    EXPECT_EQ(cold.exit_code, 2);
    EXPECT_NE(cold.errors.find("the frames have no array temperature"), std::string::npos) << cold.errors;
    EXPECT_EQ(render(plain, "c.png", {"--black-body", "20"}).exit_code, 2);
}

TEST_F(Shapes, WarnsThatAClosedColliderHidesTheParticles) {
    const std::string box = run("box", R"("particles": [{"position": [0, 0, 0]}, {"position": [0.2, 0, 0]}],
        "colliders": [{"name": "crate", "type": "box", "size": [1, 1, 1]}])");
    const std::string note = "note: most particles are inside \"crate\"";
    EXPECT_NE(render(box, "p.png").output.find(note), std::string::npos);
    EXPECT_EQ(render(box, "p.png", {"--glass", "crate"}).output.find("note"), std::string::npos);
    EXPECT_EQ(render(box, "p.png", {"--hide", "crate"}).output.find("note"), std::string::npos);
    EXPECT_EQ(render(box, "p.png", {"--camera", "0.4,0,0,0,0,0"}).output.find("note"), std::string::npos);
    const std::string beside = run("beside", R"("particles": [{"position": [0, 0, 4]}],
        "colliders": [{"name": "crate", "type": "box", "size": [1, 1, 1]}])");
    EXPECT_EQ(render(beside, "p.png").output.find("note"), std::string::npos);
    const std::string drum = run("drum", R"("particles": [{"position": [0, 0, 0]}],
        "colliders": [{"name": "drum", "type": "box", "size": [1, 1, 1],
                       "motion": [{"time": 0, "position": [0, 0, 0]}, {"time": 1, "position": [0.2, 0, 0]}]}])");
    EXPECT_NE(render(drum, "p.png").output.find("inside \"drum\""), std::string::npos);
}

// A moving collider must look bit for bit like a collider at rest at the same position.
TEST_F(Shapes, MovingCollidersHaveTheirLooksAndTheColoursOfTheirImpacts) {
    const std::string ball = R"("particles": [{"position": [0, 0, 1.2], "velocity": [0, 0, -6], "radius": 0.1}],
        "colliders": [{"name": "box", "type": "box", "size": [1, 1, 1], )";
    const std::string moves = R"("motion": [{"time": 0, "position": [0, 0, 0]}, {"time": 1, "position": [0, 0, 0]}])";
    const std::vector<std::string> view = {"--camera", "2,-3,2,0,0,0"};
    for (const std::string looks : {R"("looks": {"color": [0.6, 0.1, 0.1]})", R"("looks": {"roughness": 0.05})",
                                    R"("looks": {"glass": true})", R"("looks": {"hidden": true})"}) {
        const std::string still = picture(run("still", ball + looks + R"(, "position": [0, 0, 0]}])"), view);
        EXPECT_TRUE(still == picture(run("moving", ball + looks + ", " + moves + "}]"), view)) << looks;
        EXPECT_TRUE(still != picture(run("plain", ball + moves + "}]"), view)) << looks;
    }
    std::vector<std::string> hits = view;
    hits.insert(hits.end(), {"--collider-color", "hits"});
    const std::string still = picture(run("still", ball + R"("position": [0, 0, 0]}])"), hits);
    EXPECT_TRUE(still == picture(run("moving", ball + moves + "}]"), hits));
    EXPECT_TRUE(still != picture(run("moving", ball + moves + "}]"), view));
}

// Several kinds of drawing, far from each other. Each picture shows one of them, with 16 pixels per metre.
const std::string kTwoKinds = R"("emitters": [
    {"name": "streaks", "type": "point", "burst": 1, "velocity": [5, 0, 0], "particle_radius": 0.25,
     "drawing": {"particles": "streaks"}},
    {"name": "shards", "type": "point", "center": [0, 0, 40], "burst": 1, "particle_radius": 1,
     "drawing": {"particles": "meshes", "mesh": "flat.obj"}},
    {"name": "pieces", "type": "child", "parent": "shards", "on": "birth", "count": 1, "velocity": [0, 0, 100],
     "particle_radius": 1},
    {"name": "balls", "type": "point", "center": [0, 0, -40], "burst": 1, "particle_radius": 1}],
    "picture": {"shutter": 0.2})";

std::string looking_at(double x, double z) {
    return std::to_string(x) + ",-10," + std::to_string(z) + "," + std::to_string(x) + ",0," + std::to_string(z) +
           ",22.6198649480404";
}

TEST_F(Shapes, ParticlesAreDrawnAsTheirEmitterRequests) {
    // The mesh is a needle in the xy plane. Its particles do not spin. Each has its own orientation, and its length is
    // within one radius of the centre.
    (void)folder_.write("flat.obj", "v 1 0 0\nv -1 0.02 0\nv -1 -0.02 0\nf 1 2 3\nf 3 2 1\n");
    const std::string output = run("kinds", kTwoKinds);
    const auto streak = extent(output, {"--camera", looking_at(1.5, 0)});
    EXPECT_NEAR(streak.first, 16 * 1.5, 2);  // 0.2 s at 5 m/s, and two radii
    EXPECT_NEAR(streak.second, 16 * 0.5, 2);
    const auto ball = extent(output, {"--camera", looking_at(0, -40)});
    EXPECT_NEAR(ball.first, 32, 2);
    EXPECT_NEAR(ball.second, 32, 2);
    const auto is_needle = [](const std::pair<int, int>& size) {
        return size.first <= 34 && size.second <= 34 && (size.first < 30 || size.second < 30);
    };
    EXPECT_TRUE(is_needle(extent(output, {"--camera", looking_at(0, 40)})));
    EXPECT_TRUE(is_needle(extent(output, {"--camera", looking_at(0, 80)}))) << "children are drawn as their parents";
    const auto as_balls = extent(output, {"--camera", looking_at(0, 40), "--draw", "spheres", "--shutter", "0"});
    EXPECT_NEAR(as_balls.first, 32, 2);
    EXPECT_NEAR(as_balls.second, 32, 2);
    std::filesystem::remove(folder_.path("flat.obj"));
    EXPECT_TRUE(is_needle(extent(output, {"--camera", looking_at(0, 40)}))) << "the run keeps its own";
}

TEST_F(Shapes, FlatDrawingsOfSeveralKindsAreDrawnOverSolidOnes) {
    const std::string output = run("flat", R"("emitters": [
        {"name": "glow", "type": "point", "center": [-2, 0, 0], "burst": 1, "particle_radius": 0.4, "color": [1, 0, 0],
         "drawing": {"particles": "glow"}},
        {"name": "soft", "type": "point", "center": [0, 0, 0], "burst": 1, "particle_radius": 0.4, "color": [0, 1, 0],
         "drawing": {"particles": "soft"}},
        {"name": "dots", "type": "point", "center": [2, 0, 0], "burst": 1, "particle_radius": 0.4, "color": [0, 0, 1],
         "drawing": {"particles": "sprites", "sprite": "white.png"}},
        {"name": "balls", "type": "point", "center": [0, 0, -1.2], "burst": 1, "particle_radius": 0.4,
         "color": [1, 1, 1]}])");
    (void)picture(output, {"--camera", looking_at(0, 0), "--background", "0,0,0", "--no-filter"});
    const Image image = read_png(folder_.path("p.png"));
    const auto at = [&](double x, double z) {
        const auto column = static_cast<std::size_t>(48 + 16 * x);
        const auto row = static_cast<std::size_t>(32 - 16 * z);
        const std::uint8_t* pixel = &image.rgb[3 * (row * 96 + column)];
        return std::vector<int>{pixel[0], pixel[1], pixel[2]};
    };
    const auto red = at(-2, 0), green = at(0, 0), blue = at(2, 0), ball = at(0, -1.2);
    EXPECT_TRUE(red[0] > 2 * red[1] && red[0] > 2 * red[2]);
    EXPECT_TRUE(green[1] > 2 * green[0] && green[1] > 2 * green[2]);
    EXPECT_TRUE(blue[2] > 2 * blue[0] && blue[2] > 2 * blue[1]);
    EXPECT_TRUE(ball[0] > 60 && ball[1] > 60 && ball[2] > 60);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
