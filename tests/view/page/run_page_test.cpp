#include "view/page/run_page.h"

#include <gtest/gtest.h>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "view/page/moving_run.h"
#include "view/page/page_reader.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::MadeRun;
using test::ReadFrame;
using test::ReadPage;

/// Frames of particles on parabolas. In every frame some particles are removed and some are added.
struct Shower {
    std::vector<VtkPolyData> frames;

    Shower(int frame_count, std::int64_t particle_count) {
        for (int f = 0; f < frame_count; ++f) frames.push_back(frame(f, frame_count, particle_count));
    }

    static VtkPolyData frame(int f, int frame_count, std::int64_t particle_count) {
        VtkPolyData data;
        std::vector<std::int64_t> ids;
        std::vector<Vec3> velocities;
        std::vector<double> ages;
        std::vector<std::uint32_t> contacts;
        for (std::int64_t id = 0; id < particle_count; ++id) {
            RandomSequence random(3, 4, static_cast<std::uint64_t>(id));
            const double birth = (random.uniform() - 0.5) * frame_count;
            const double age = 0.1 * (f - birth);
            if (age < 0.0 || age > 0.07 * frame_count) continue;
            const Vec3 v = 3.0 * random.unit_vector();
            data.points.push_back({v.x * age, v.y * age, 5.0 + v.z * age - 4.9 * age * age});
            velocities.push_back({v.x, v.y, v.z - 9.8 * age});
            ids.push_back(1000 + 3 * id);
            ages.push_back(age);
            contacts.push_back(static_cast<std::uint32_t>((id + f) % 7));
        }
        std::vector<double> masses(ids.size(), 2.5);
        data.point_arrays = list_of(VtkArray{"id", std::move(ids)}, VtkArray{"velocity", std::move(velocities)},
                                    VtkArray{"age", std::move(ages)}, VtkArray{"contacts", std::move(contacts)},
                                    VtkArray{"mass", std::move(masses)});
        return data;
    }
    [[nodiscard]] RunFolder written(MadeRun& run) const {
        for (const VtkPolyData& data : frames) run.add_frame(data);
        return run.finish();
    }
};

ReadPage page_of(const RunFolder& folder, const MadeRun& run, const PageOptions& options = {}) {
    (void)write_run_page(folder, run.folder.path("page.html"), options);
    return ReadPage(run.folder.read("page.html"));
}

template <class Values>
const Values& array_of(const VtkPolyData& frame, const char* name) {
    return std::get<Values>(find_array(frame.point_arrays, name)->values);
}

void expect_same(const ReadPage& page, const ReadFrame& told, const VtkPolyData& meant) {
    ASSERT_EQ(told.ids, array_of<std::vector<std::int64_t>>(meant, "id"));
    const double step = page.description.at("grid").at("step");
    const auto& ages = page.description.at("attributes").at(page.attribute("age"));
    for (std::size_t row = 0; row < told.ids.size(); ++row) {
        const std::array<double, 3> place = page.position(told, row);
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_NEAR(place[static_cast<std::size_t>(axis)], meant.points[row][axis], 0.5001 * step);
        }
        ASSERT_NEAR(page.value(told, "age", row), array_of<std::vector<double>>(meant, "age")[row],
                    0.5001 * ages.at("step").get<double>());
        ASSERT_EQ(page.value(told, "contacts", row), array_of<std::vector<std::uint32_t>>(meant, "contacts")[row]);
        ASSERT_EQ(page.value(told, "mass", row), 2.5);
    }
}

TEST(RunPage, EveryParticleOfEveryFrameIsStoredToHalfAStep) {
    MadeRun run;
    const Shower shower(25, 400);
    const ReadPage page = page_of(shower.written(run), run);
    ASSERT_EQ(page.frames.size(), shower.frames.size());
    EXPECT_EQ(page.description.at("positionBits"), 16);
    for (std::size_t f = 0; f < page.frames.size(); ++f) expect_same(page, page.frames[f], shower.frames[f]);
    EXPECT_EQ(page.description.at("notes").size(), 0U);
}

TEST(RunPage, PageWithoutDataTakesLessThanAMegabyte) {
    MadeRun run;
    run.add_frame(test::point_frame({}, {}));
    const ReadPage page = page_of(run.finish(), run);
    EXPECT_LT(page.text.size(), 1'000'000U);
    EXPECT_EQ(page.frames.size(), 1U);
}

TEST(RunPage, BudgetIsKeptAndReductionsAreReported) {
    MadeRun run;
    const Shower shower(120, 6000);
    const RunFolder folder = shower.written(run);
    const auto size_for = [&](double budget) {
        PageOptions options;
        options.budget = budget;
        const PageReport report = write_run_page(folder, run.folder.path("page.html"), options);
        const ReadPage page(run.folder.read("page.html"));
        EXPECT_LE(static_cast<double>(page.text.size()), budget);
        EXPECT_EQ(page.text.size(), report.bytes);
        EXPECT_EQ(page.frames.size(), report.frames);
        EXPECT_EQ(page.description.at("notes").size(), report.notes.size());
        return report;
    };
    const PageReport all = size_for(1e9);
    EXPECT_TRUE(all.notes.empty());
    const PageReport most = size_for(0.85 * static_cast<double>(all.bytes));
    ASSERT_EQ(most.notes.size(), 1U);
    EXPECT_NE(most.notes[0].find("bits"), std::string::npos) << most.notes[0];
    EXPECT_EQ(most.frames, all.frames);
    const PageReport few = size_for(1.2e6);
    ASSERT_EQ(few.notes.size(), 1U);
    EXPECT_NE(few.notes[0].find("frames"), std::string::npos) << few.notes[0];
    EXPECT_LT(few.frames, all.frames);
}

TEST(RunPage, BudgetTooSmallForAPageIsRefused) {
    MadeRun run;
    const Shower shower(5, 50);
    const RunFolder folder = shower.written(run);
    PageOptions options;
    options.budget = 2e5;
    EXPECT_THROW((void)write_run_page(folder, run.folder.path("page.html"), options), InputError);
    EXPECT_FALSE(std::filesystem::exists(run.folder.path("page.html")));
}

TEST(RunPage, BytesDoNotDependOnTheNumberOfThreads) {
    MadeRun run;
    const Shower shower(20, 300);
    const RunFolder folder = shower.written(run);
    const std::string many = page_of(folder, run).text;
    const ThreadLimit limit(1);
    EXPECT_EQ(page_of(folder, run).text, many);
}

TEST(RunPage, TextFromFilesIsNeverInterpretedByTheBrowser) {
    const std::string strange = "</script><script>alert(1)</script><!--\x1b\xff\xe2\x80\xae@MODULES@";
    MadeRun run;
    run.add_still(strange, test::box_mesh({0, 0, 0}, {1, 1, 1}));
    VtkPolyData frame = test::point_frame({{0, 0, 2}}, {1});
    frame.point_arrays.push_back({"</script><b>", std::vector<double>{1.0}});
    run.add_frame(frame);
    (void)run.finish("a.json");
    // The names of scene and collider go through run.json, the name of the array through the frame.
    RunFolder folder = open_run_folder(run.folder.path(""));
    folder.info.scene = "x/</title><script>alert(2)</script>.json";
    folder.info.colliders[0].name = strange;
    const ReadPage page = page_of(folder, run);
    EXPECT_EQ(page.text.find("<script>alert"), std::string::npos);
    EXPECT_EQ(page.text.find("<b>"), std::string::npos);
    EXPECT_EQ(page.text.find('\x1b'), std::string::npos);
    EXPECT_EQ(page.text.find("\xe2\x80\xae"), std::string::npos);
    EXPECT_EQ(page.frames.size(), 1U);
    EXPECT_NE(page.description.at("parts")[0].at("name").get<std::string>().find("@MODULES@"), std::string::npos);
}

// The page's own text must not load anything either.
TEST(RunPage, PageLoadsNothingFromElsewhere) {
    MadeRun run;
    run.add_frame(test::point_frame({{0, 0, 2}}, {1}));
    const std::string text = page_of(run.finish(), run).text;
    for (const char* tag : {" src=", " href=", "<link", "<img", "<iframe", "url(", "@import", "http://", "https://"}) {
        EXPECT_EQ(text.find(tag), std::string::npos) << tag;
    }
    EXPECT_NE(text.find("default-src 'none'"), std::string::npos);
}

TEST(RunPage, DistantOutliersAreLeftOutAndReported) {
    MadeRun run;
    std::vector<Vec3> points;
    std::vector<std::int64_t> ids;
    for (int i = 0; i < 300; ++i) {
        points.push_back({std::cos(i), std::sin(i), 0.01 * i});
        ids.push_back(i);
    }
    points[7] = {1e9, 0, 0};
    points[9] = {std::nan(""), 0, 0};
    run.add_frame(test::point_frame(points, ids));
    const ReadPage page = page_of(run.finish(), run);
    EXPECT_EQ(page.frames[0].ids.size(), 298U);
    EXPECT_LT(page.description.at("grid").at("step").get<double>(), 1e-3);
    ASSERT_EQ(page.description.at("notes").size(), 1U);
}

/// A wall through the origin and touching spheres of two sizes, at other points of the wall in every frame.
struct Touching {
    Vec3 normal = normalized(Vec3{0.3, -0.2, 1.0});
    Vec3 u = normalized(cross(normal, {0, 1, 0}));
    Vec3 v = cross(normal, u);
    MadeRun run;

    RunFolder written() {
        run.add_still("wall", {{6.1 * (-u - v), 6.3 * (u - v), 5.9 * (u + v), 6.2 * (v - u)}, {{0, 1, 2}, {0, 2, 3}}});
        for (std::uint32_t f = 0; f < 12; ++f) run.add_frame(frame(f));
        return run.finish();
    }
    [[nodiscard]] VtkPolyData frame(std::uint32_t f) const {
        std::vector<Vec3> points;
        std::vector<std::int64_t> ids;
        std::vector<double> radii;
        for (std::int64_t id = 0; id < 3000; ++id) {
            RandomSequence random(5, f, static_cast<std::uint64_t>(id));
            const double across = 10.0 * (random.uniform() - 0.5);
            const double along = 10.0 * (random.uniform() - 0.5);
            radii.push_back(id % 2 == 0 ? 0.5 : 0.02);
            points.push_back(across * u + along * v + radii.back() * normal);
            ids.push_back(id);
        }
        VtkPolyData data = test::point_frame(std::move(points), std::move(ids));
        data.point_arrays.push_back({"radius", std::move(radii)});
        return data;
    }
};

// Returns the depth offset that page and script subtract for spheres (Run.slack in web/run.js).
double slack_of(const ReadPage& page) {
    const auto& radius = page.description.at("attributes").at(page.attribute("radius"));
    double walls = 0.0;
    for (const auto& part : page.description.at("parts")) walls = std::max(walls, part.at("error").get<double>());
    return 0.5 * std::sqrt(3.0) * page.description.at("grid").at("step").get<double>() +
           0.5 * radius.at("step").get<double>() + walls;
}

TEST(RunPage, SpheresThatTouchAWallPassItByLessThanTheSlack) {
    Touching touching;
    const RunFolder folder = touching.written();
    for (const double budget : {1e9, 0.82e6}) {
        PageOptions options;
        options.budget = budget;
        const ReadPage page = page_of(folder, touching.run, options);
        const double slack = slack_of(page);
        double farthest = 0.0;
        for (std::size_t row = 0; row < page.frames[0].ids.size(); ++row) {
            const std::array<double, 3> place = page.position(page.frames[0], row);
            const double height = dot(touching.normal, {place[0], place[1], place[2]});
            farthest = std::max(farthest, page.value(page.frames[0], "radius", row) - height);
        }
        EXPECT_GT(farthest, 0.0);
        EXPECT_LT(farthest, slack);
        // Smaller spheres count as spheres of a quarter of the largest radius.
        EXPECT_LT(slack, 0.12 * 0.125) << page.description.at("positionBits");
        EXPECT_EQ(page.description.at("valueBits"), budget == 1e9 ? 16 : 8);
        EXPECT_LT(page.description.at("attributes").at(page.attribute("radius")).at("step").get<double>(), 1e-5);
    }
}

TEST(RunPage, LooksOfCollidersAreStored) {
    MadeRun run;
    run.add_still("mirror", test::box_mesh({0, 0, 0}, {1, 1, 1}));
    run.add_still("lid", test::box_mesh({0, 0, 2}, {1, 1, 3}));
    run.add_frame(test::point_frame({{0, 0, 2}}, {1}));
    RunFolder folder = run.finish();
    folder.info.colliders[0].looks.roughness = 0.125;
    folder.info.colliders[1].looks.hidden = true;
    const ReadPage page = page_of(folder, run);
    const auto& parts = page.description.at("parts");
    EXPECT_EQ(parts[0].at("roughness"), 0.125);
    EXPECT_EQ(parts[0].at("hidden"), false);
    EXPECT_EQ(parts[1].at("roughness"), 1.0);
    EXPECT_EQ(parts[1].at("hidden"), true);
}

TEST(RunPage, PatternFlagOfPlanesIsStored) {
    MadeRun run;
    run.add_plane("floor");
    run.add_plane("wall");
    run.add_frame(test::point_frame({{0, 0, 2}}, {1}));
    RunFolder folder = run.finish();
    folder.info.colliders[1].looks.pattern = false;
    const ReadPage page = page_of(folder, run);
    EXPECT_EQ(page.description.at("parts")[0].at("pattern"), true);
    EXPECT_EQ(page.description.at("parts")[1].at("pattern"), false);
}

TEST(RunPage, SpringsConnectTheRowsOfTheirFrame) {
    MadeRun run;
    VtkPolyData frame = test::point_frame({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {4, 5, 6, 9});
    frame.lines = {{0, 3}, {3, 1}};
    frame.triangles = {{0, 1, 2}};
    frame.has_vertices = true;
    run.add_frame(frame);
    run.add_frame(frame);
    frame.lines.pop_back();
    run.add_frame(frame);
    const ReadPage page = page_of(run.finish(), run);
    EXPECT_EQ(page.frames[0].lines, (std::vector<std::uint32_t>{0, 3, 3, 1}));
    EXPECT_EQ(page.frames[1].lines, page.frames[0].lines);
    EXPECT_EQ(page.frames[2].lines, (std::vector<std::uint32_t>{0, 3}));
    EXPECT_EQ(page.frames[2].triangles, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(RunPage, FramesThatDoNotBelongTogetherAreRefused) {
    MadeRun run;
    run.add_frame(test::point_frame({{0, 0, 0}, {1, 0, 0}}, {5, 4}));
    const RunFolder unordered = run.finish();
    EXPECT_THROW((void)write_run_page(unordered, run.folder.path("page.html"), {}), InputError);
    MadeRun other;
    VtkPolyData frame = test::point_frame({{0, 0, 0}}, {5});
    frame.point_arrays.push_back({"heat", std::vector<double>{1.0}});
    other.add_frame(frame);
    other.add_frame(test::point_frame({{0, 0, 0}}, {5}));
    EXPECT_THROW((void)write_run_page(other.finish(), other.folder.path("page.html"), {}), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
