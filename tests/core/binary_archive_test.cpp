#include "ricochet/core/binary_archive.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "ricochet/core/error.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Bytes = std::vector<std::byte>;

template <class Write>
Bytes written(const Write& write) {
    Bytes bytes;
    BinaryWriter writer([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    write(writer);
    return bytes;
}

BinaryReader reader_of(const Bytes& bytes) {
    return BinaryReader([&bytes, at = std::size_t{0}](std::span<std::byte> part) mutable {
        if (bytes.size() - at < part.size()) throw InputError("the end");
        std::memcpy(part.data(), bytes.data() + at, part.size());
        at += part.size();
    });
}

TEST(BinaryArchive, RestoresWrittenValues) {
    std::vector<Vec3> many(100'000, Vec3{1, 2, 3});
    many.back() = {4, 5, 6};
    const Bytes bytes =
        written([&](BinaryWriter& a) { a(many), a(std::string("text")), a(true), a(std::vector<int>{}); });
    BinaryReader reader = reader_of(bytes);
    std::vector<Vec3> list{{7, 7, 7}};
    std::string text;
    bool flag = false;
    std::vector<int> none{1};
    reader(list), reader(text), reader(flag), reader(none);
    EXPECT_EQ(list, many);
    EXPECT_EQ(text, "text");
    EXPECT_TRUE(flag);
    EXPECT_TRUE(none.empty());
}

// A damaged length claims 2^60 entries of 24 bytes, but only eight bytes follow.
TEST(BinaryArchive, AllocatesNoMoreMemoryThanTheFileHasBytes) {
    const Bytes bytes = written([](BinaryWriter& a) { a(std::uint64_t{1} << 60), a(std::uint64_t{0}); });
    BinaryReader reader = reader_of(bytes);
    std::vector<Vec3> list;
    EXPECT_THROW(reader(list), InputError);
    EXPECT_LE(list.capacity() * sizeof(Vec3), std::size_t{2} << 20);
    BinaryReader again = reader_of(bytes);
    std::vector<std::string> texts;
    EXPECT_THROW(archive_entries(again, texts, [&](std::string& text) { again(text); }), InputError);
    EXPECT_LE(texts.capacity(), 4U);
}

TEST(BinaryArchive, RefusesListsOfInconsistentLengths) {
    const Bytes bytes = written([](BinaryWriter& a) { a(std::vector<double>{1, 2, 3}); });
    std::vector<double> list;
    EXPECT_THROW(reader_of(bytes)(list, 2), InputError);
    EXPECT_THROW(reader_of(bytes).all_or_none(list, 2, 0.0), InputError);
    BinaryReader entries = reader_of(bytes);
    EXPECT_THROW(archive_entries(
                     entries, list, [&](double& x) { entries(x); }, 4),
                 InputError);
    reader_of(bytes)(list, 3);
    EXPECT_EQ(list.size(), 3U);
    const Bytes empty = written([](BinaryWriter& a) { a(std::vector<double>{}); });
    reader_of(empty).all_or_none(list, 2, 0.0);
    EXPECT_TRUE(list.empty());
}

TEST(BinaryArchive, RefusesInvalidBooleans) {
    bool flag = false;
    const Bytes bytes = written([](BinaryWriter& a) { a(std::uint8_t{2}); });
    EXPECT_THROW(reader_of(bytes)(flag), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
