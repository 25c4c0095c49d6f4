#include "view/page/channel_encoder.h"

#include <gtest/gtest.h>

#include "ricochet/core/random.h"
#include "view/page/page_reader.h"

namespace ricochet {
namespace RICOCHET_FILE {

// Rows with values of any kind: jumps, noise and polynomials. In every frame some rows are removed and some are added.
struct Course {
    RandomSequence random;
    std::vector<std::uint32_t> ids;
    std::uint32_t next_id = 0;

    explicit Course(std::uint64_t seed) : random(seed, 2, 0) {}

    // Advances to the next frame. Returns the index that each of its rows had in the frame before.
    std::vector<std::uint32_t> next() {
        std::vector<std::uint32_t> parents;
        std::vector<std::uint32_t> kept;
        for (std::uint32_t row = 0; row < ids.size(); ++row) {
            if (random.uniform() < 0.1) continue;
            parents.push_back(row);
            kept.push_back(ids[row]);
        }
        for (int births = static_cast<int>(40.0 * random.uniform()); births > 0; --births) {
            parents.push_back(RowHistory::kNew);
            kept.push_back(next_id++);
        }
        ids = kept;
        return parents;
    }
    Levels values(int frame, int bits) {
        const std::uint32_t mask = (1U << static_cast<unsigned>(bits)) - 1U;
        Levels levels;
        for (const std::uint32_t id : ids) {
            const auto t = static_cast<std::uint32_t>(frame);
            const std::uint32_t smooth = id * 77 + t * (id % 13) - 5 * t * t;
            const bool jumps = random.uniform() < 0.05;
            levels.push_back(static_cast<std::uint16_t>((jumps ? random.draws() * 7919 : smooth) & mask));
        }
        return levels;
    }
};

TEST(ChannelEncoder, EveryValueIsDecodedExactlyAsRowsComeAndGo) {
    for (const int bits : {8, 11, 12, 14, 16}) {
        Course course(static_cast<std::uint64_t>(bits));
        RowHistory rows;
        RowHistory read_rows;
        ChannelEncoder encoder(bits);
        test::PageChannel decoder(bits);
        for (int frame = 0; frame < 30; ++frame) {
            const std::vector<std::uint32_t> parents = course.next();
            const Levels values = course.values(frame, bits);
            rows.follow(parents);
            read_rows.follow(parents);
            ByteWriter out;
            encoder.encode(values, rows, out);
            test::PageBytes in(out.bytes());
            ASSERT_EQ(decoder.decode(in, read_rows), values) << bits << " bits, frame " << frame;
            EXPECT_TRUE(in.is_at_end());
        }
    }
}

TEST(ChannelEncoder, ParabolasArePredictedWithoutResiduals) {
    RowHistory rows;
    ChannelEncoder encoder(16);
    for (int frame = 0; frame < 6; ++frame) {
        Levels values;
        for (int row = 0; row < 100; ++row) {
            values.push_back(static_cast<std::uint16_t>(20'000 + 300 * row + 57 * frame - 9 * frame * frame));
        }
        rows.follow_same(values.size());
        ByteWriter out;
        encoder.encode(values, rows, out);
        if (frame < 3) continue;
        EXPECT_EQ(out.bytes(), '\2' + std::string(200, '\0')) << frame;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
