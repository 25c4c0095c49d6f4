// The saved parts of several processes must read like the file of one process.
#include "ricochet/core/merging_reader.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Lists indexed by ids, as in a simulation.
struct Lists {
    std::uint64_t common = 7;
    std::vector<std::uint64_t> ids;
    std::vector<double> pairs;         // two for each id
    std::vector<double> rare;          // one for each id, or empty if all are absent
    std::vector<std::uint32_t> marks;  // saved one by one

    void append(std::uint64_t id, bool is_rare) {
        const auto number = static_cast<double>(id);
        ids.push_back(id);
        pairs.insert(pairs.end(), {number, -number});
        if (is_rare) {
            rare.resize(ids.size() - 1, -1.0);
            rare.push_back(0.5 * number);
        } else if (!rare.empty()) {
            rare.push_back(-1.0);
        }
        marks.push_back(static_cast<std::uint32_t>(3 * id));
    }

    template <class Archive>
    void archive(Archive& a) {
        a(common);
        a(ids);
        a(pairs, 2 * ids.size());
        a.all_or_none(rare, ids.size(), -1.0);
        archive_entries(
            a, marks, [&a](std::uint32_t& mark) { a(mark); }, ids.size());
    }
};

std::vector<std::byte> bytes_of(Lists& lists) {
    std::vector<std::byte> bytes;
    BinaryWriter writer([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    lists.archive(writer);
    return bytes;
}

TEST(MergingReader, ReadsTheSameValuesAsFromOneProcess) {
    RandomSequence random(4, 0, 0);
    for (int round = 0; round < 200; ++round) {
        SCOPED_TRACE(round);
        Lists whole;
        std::vector<Lists> parts(1 + static_cast<std::size_t>(random.uniform() * 6.0));
        const double change = random.uniform();  // selects long or short runs of one part
        const auto count = static_cast<std::uint64_t>(random.uniform() * 60.0);
        std::size_t owner = 0;
        for (std::uint64_t k = 0; k < count; ++k) {
            const std::uint64_t id = 3 * k + (random.uniform() < 0.5 ? 1 : 0);
            if (random.uniform() < change) owner = static_cast<std::size_t>(random.uniform() * 7.0) % parts.size();
            const bool is_rare = round % 3 != 0 && random.uniform() < 0.1;
            whole.append(id, is_rare);
            parts[owner].append(id, is_rare);
        }
        std::vector<std::vector<std::byte>> saved;
        for (Lists& part : parts) saved.push_back(bytes_of(part));
        Lists read;
        MergingReader reader(saved);
        read.archive(reader);
        EXPECT_EQ(read.ids, whole.ids);
        EXPECT_EQ(read.pairs, whole.pairs);
        EXPECT_EQ(read.rare, whole.rare);
        EXPECT_EQ(read.marks, whole.marks);
        EXPECT_EQ(read.common, 7U);
    }
}

TEST(MergingReader, RefusesListsOfInconsistentLengths) {
    Lists part;
    part.append(1, false);
    part.pairs.push_back(0.0);
    const std::vector<std::vector<std::byte>> saved = {bytes_of(part)};
    Lists read;
    MergingReader reader(saved);
    EXPECT_THROW(read.archive(reader), RunError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
