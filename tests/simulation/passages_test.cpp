// Passages of single paths through a disk: the half-open rule, curved paths, the rim, and gaps between pieces.
#include "ricochet/simulation/counters/passages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Returns the passages of a path as letters: f forward, b backward.
std::string letters(const std::vector<Passage>& passages) {
    std::string all;
    for (const Passage& passage : passages) all += passage.is_forward ? 'f' : 'b';
    return all;
}

CounterDescription disk(double height, double radius = 1.0, const Vec3& normal = {0, 0, 1}) {
    return {"disk", DiskCounter{{0, 0, height}, normal, radius}};
}

FlownPiece piece(const Path& path) { return {path, 0.0, path.duration, {}, {}, true}; }

std::string along(const CounterDescription& counter, const std::vector<FlownPiece>& pieces, const Vec3& from,
                  const Vec3& to) {
    std::vector<Passage> passages;
    PassageFinder({&counter, 1}).trace({7, 0.5, from, to}, pieces, passages);
    for (const Passage& passage : passages) {
        EXPECT_EQ(passage.particle, 7U);
        EXPECT_EQ(passage.mass, 0.5);
    }
    return letters(passages);
}

/// Returns the passages of a path through heights, with one move from each to the next.
std::string over(const CounterDescription& counter, const std::vector<double>& heights) {
    std::string all;
    for (std::size_t k = 1; k < heights.size(); ++k) {
        const Vec3 from{0, 0, heights[k - 1]};
        const Vec3 to{0, 0, heights[k]};
        all += along(counter, {piece(line_path(from, to - from, 1.0))}, from, to);
    }
    return all;
}

TEST(Passages, DiskBelongsToItsFrontSide) {
    EXPECT_EQ(over(disk(0.5), {0.0, 1.0}), "f");
    EXPECT_EQ(over(disk(0.5), {1.0, 0.0}), "b");
    EXPECT_EQ(over(disk(0.5), {0.0, 0.5}), "f");
    EXPECT_EQ(over(disk(0.5), {0.5, 0.0}), "b");
    EXPECT_EQ(over(disk(0.5), {0.0, 0.5, 1.0}), "f");
    EXPECT_EQ(over(disk(0.5), {1.0, 0.5, 0.0}), "b");
    EXPECT_EQ(over(disk(0.5), {0.0, 0.5, 0.0}), "fb");
    EXPECT_EQ(over(disk(0.5), {1.0, 0.5, 1.0}), "");
    EXPECT_EQ(over(disk(0.5), {0.5, 0.5, 0.5}), "");
    EXPECT_EQ(over(disk(0.5, 1.0, {0, 0, -3}), {0.0, 0.5, 1.0}), "b");
    EXPECT_EQ(over(disk(0.5, 1.0, {0, 0, -3}), {1.0, 0.5, 0.0}), "f");
}

TEST(Passages, CurvedPathCountsOnceEachWay) {
    const Path throw_up = parabola_path({0, 0, 0}, {0, 0, 4}, {0, 0, -8}, 1.0);  // up to 1 m and back to 0
    EXPECT_EQ(along(disk(0.75), {piece(throw_up)}, throw_up.c[0], throw_up.end), "fb");
    EXPECT_EQ(along(disk(1.25), {piece(throw_up)}, throw_up.c[0], throw_up.end), "");
    EXPECT_EQ(along(disk(-0.1), {piece(throw_up)}, throw_up.c[0], throw_up.end), "");
    FlownPiece half = piece(throw_up);
    half.duration = 0.5;
    EXPECT_EQ(along(disk(0.75), {half}, throw_up.c[0], throw_up.position(0.5)), "f");
}

TEST(Passages, CubicCountsUpToThreeTimes) {
    Path cubic = line_path({0, 0, 0}, {}, 1.0);
    cubic.degree = 3;
    cubic.c = {Vec3{0, 0, -0.1}, Vec3{0, 0, 1.0}, Vec3{0, 0, -2.4}, Vec3{0, 0, 1.6}};
    cubic.end = {0, 0, 0.1};
    // Its height rises to 0.027, falls to -0.027 and rises to 0.1.
    EXPECT_EQ(along(disk(0.05), {piece(cubic)}, cubic.c[0], cubic.end), "f");
    EXPECT_EQ(along(disk(0.015), {piece(cubic)}, cubic.c[0], cubic.end), "fbf");
    EXPECT_EQ(along(disk(0.0, 1.0, {0, 0, -1}), {piece(cubic)}, cubic.c[0], cubic.end), "bfb");
}

TEST(Passages, RimBelongsToTheDisk) {
    const auto beside = [](double x) {
        const Vec3 from{x, 0, -1};
        return along(disk(0.0, 0.25), {piece(line_path(from, {0, 0, 2}, 1.0))}, from, {x, 0, 1});
    };
    EXPECT_EQ(beside(0.0), "f");
    EXPECT_EQ(beside(0.25), "f");
    EXPECT_EQ(beside(std::nextafter(0.25, 1.0)), "");
    EXPECT_EQ(beside(-0.3), "");
}

TEST(Passages, StoredPositionDecidesAtTheEndOfAPiece) {
    // A wall coincides with the disk. The path ends on it, and the particle is stored just before it.
    const Vec3 from{0, 0, -1};
    const Vec3 before{0, 0, -1e-9};
    const Path to_wall = line_path(from, {0, 0, 1}, 1.0);
    const Path back = line_path(before, {0, 0, -1}, 0.5);
    EXPECT_EQ(along(disk(0.0), {piece(to_wall), piece(back)}, from, back.end), "");
    EXPECT_EQ(along(disk(0.0), {piece(to_wall)}, from, before), "");
    EXPECT_EQ(along(disk(-0.5), {piece(to_wall), piece(back)}, from, back.end), "fb");
}

TEST(Passages, MoveWithoutPiecesIsStraight) {
    EXPECT_EQ(along(disk(0.0), {}, {0, 0, -1}, {0, 0, 1}), "f");
    EXPECT_EQ(along(disk(0.0), {}, {0, 0, 1}, {0, 0, 1}), "");
    EXPECT_EQ(along(disk(0.0), {}, {0, 0, -1}, {0, 0, std::nan("")}), "");
}

TEST(Passages, SegmentsCountLikePieces) {
    const CounterDescription counter = disk(0.5);
    std::vector<Passage> passages;
    const std::vector<Segment> segments{{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 1}, {0, 0, 0.25}}};
    PassageFinder({&counter, 1}).trace({0, 1.0, {0, 0, 0}, {0, 0, 0.25}}, segments, passages);
    EXPECT_EQ(letters(passages), "fb");
}

TEST(Passages, BalanceIsTheChangeOfSideForAnyPath) {
    RandomSequence random(5, 1, 0);
    const auto coordinate = [&] { return std::round(8.0 * (random.uniform() - 0.5)) / 4.0; };  // often on the plane
    for (int trial = 0; trial < test::scaled(2000); ++trial) {
        SCOPED_TRACE(trial);
        const CounterDescription counter = disk(0.0, 1e9, {coordinate(), coordinate(), 1.0});
        const FlatSurface plane(std::get<DiskCounter>(counter.shape));
        Vec3 at{coordinate(), coordinate(), coordinate()};
        int balance = plane.is_in_front(at) ? 1 : 0;
        for (int k = 0; k < 6; ++k) {
            const Vec3 to{coordinate(), coordinate(), coordinate()};
            const Vec3 velocity{coordinate(), coordinate(), coordinate()};
            for (const char c : along(counter, {piece(hermite_path(at, velocity, to, velocity, 1.5))}, at, to)) {
                balance += c == 'f' ? 1 : -1;
            }
            at = to;
            ASSERT_EQ(balance, plane.is_in_front(at) ? 1 : 0);
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
