#include "cli/huge_pages.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <new>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct alignas(64) Line {
    unsigned char bytes[64];
};

/// What the kernel says of the piece of memory that holds an address, in its own letters; "hg" is the advice to use
/// huge pages.
std::string flags_of_memory_at(const void* place) {
    const auto address = reinterpret_cast<std::uintptr_t>(place);
    std::ifstream maps("/proc/self/smaps");
    std::string line;
    bool is_there = false;
    while (std::getline(maps, line)) {
        std::uintptr_t first = 0;
        std::uintptr_t last = 0;
        char dash = 0;
        std::istringstream head(line);
        if (head >> std::hex >> first >> dash >> last && dash == '-') is_there = first <= address && address < last;
        if (is_there && line.starts_with("VmFlags:")) return line;
    }
    return {};
}

TEST(LargePages, ArraysOfManyMegabytesAskForThem) {
    if (!ricochet::cli::requests_huge_pages()) GTEST_SKIP() << "here the program's memory comes from elsewhere";
    const std::vector<double> numbers(std::size_t{4} << 20);
    const std::vector<Line> lines(std::size_t{1} << 18);
    for (const void* place :
         {static_cast<const void*>(&numbers[numbers.size() / 2]), static_cast<const void*>(&lines[lines.size() / 2])}) {
        const std::string flags = flags_of_memory_at(place);
        if (flags.empty()) GTEST_SKIP() << "this system does not tell";
        EXPECT_NE(flags.find(" hg"), std::string::npos) << flags;
    }
}

TEST(LargePages, EveryAlignmentAndSizeIsServed) {
    if (!ricochet::cli::requests_huge_pages()) GTEST_SKIP() << "here the program's memory comes from elsewhere";
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{100}, std::size_t{9} << 20}) {
        void* const plain = ::operator new(size);
        ASSERT_NE(plain, nullptr);
        ::operator delete(plain);
        for (const std::size_t alignment : {32U, 64U, 4096U, 1U << 22U}) {
            void* const aligned = ::operator new (size, std::align_val_t{alignment});
            EXPECT_EQ(reinterpret_cast<std::uintptr_t>(aligned) % alignment, 0U);
            ::operator delete (aligned, std::align_val_t{alignment});
        }
    }
    // Read at run time, so that the compiler does not know better.
    volatile std::size_t too_much = std::size_t{1} << 62;
    EXPECT_THROW((void)::operator new(too_much), std::bad_alloc);
    too_much = SIZE_MAX;
    EXPECT_THROW((void)::operator new(too_much), std::bad_alloc);
    EXPECT_THROW((void)::operator new (too_much, std::align_val_t{64}), std::bad_alloc);
}

}  // namespace
