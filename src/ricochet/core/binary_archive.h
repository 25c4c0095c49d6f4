/// \file
/// Serialization of values to bytes and back, for states that are saved and resumed on one kind of machine.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "ricochet/core/byte_stream.h"
#include "ricochet/core/error.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// True for types that are saved as a copy of their bytes in memory: types without pointers and padding.
template <class T>
inline constexpr bool kIsFlat = std::is_arithmetic_v<T> || std::is_enum_v<T>;  // std::byte is an enumeration
template <>
inline constexpr bool kIsFlat<Vec3> = true;
template <class T, std::size_t n>
inline constexpr bool kIsFlat<std::array<T, n>> = kIsFlat<T>;

/// Archive that writes values as bytes. A type has one function template for writing and reading, which calls
/// archive(x.member) for every member. Each call saves or restores that member.
class BinaryWriter {
public:
    static constexpr bool kReads = false;

    explicit BinaryWriter(ByteSink sink) : sink_(std::move(sink)) {}

    template <class T>
    requires kIsFlat<T>
    void operator()(const T& value) { sink_(std::as_bytes(std::span(&value, 1))); }
    template <class T>
    requires kIsFlat<T>
    void operator()(const std::vector<T>& values) {
        (*this)(static_cast<std::uint64_t>(values.size()));
        if (!values.empty()) sink_(std::as_bytes(std::span(values)));
    }
    /// Writes a list that must have `size` entries, because it belongs to another list. Only the reader checks the
    /// length.
    template <class T>
    requires kIsFlat<T>
    void operator()(const std::vector<T>& values, std::size_t size) {
        static_cast<void>(size);
        (*this)(values);
    }
    /// Writes a list that has `size` entries or none. An empty list stands for `size` entries of the value `absent`.
    template <class T>
    void all_or_none(const std::vector<T>& values, std::size_t size, const T& absent) {
        static_cast<void>(absent);
        (*this)(values, size);
    }
    void operator()(const std::string& text) {
        (*this)(static_cast<std::uint64_t>(text.size()));
        if (!text.empty()) sink_(std::as_bytes(std::span(text)));
    }

private:
    ByteSink sink_;
};

/// Archive that reads the output of a BinaryWriter, in the same order. Lists grow while they are read, so damaged
/// lengths never allocate more than a few times the size of the input.
class BinaryReader {
public:
    static constexpr bool kReads = true;

    explicit BinaryReader(ByteSource source) : source_(std::move(source)) {}

    template <class T>
    requires kIsFlat<T>
    void operator()(T& value) { source_(std::as_writable_bytes(std::span(&value, 1))); }
    void operator()(bool& value) {
        std::uint8_t byte = 0;
        (*this)(byte);
        if (byte > 1) throw InputError("a saved truth value is neither 0 nor 1");
        value = byte == 1;
    }
    template <class T>
    requires kIsFlat<T>
    void operator()(std::vector<T>& values) { fill(values, length()); }
    /// Throws InputError unless the list has `size` entries.
    template <class T>
    requires kIsFlat<T>
    void operator()(std::vector<T>& values, std::size_t size) {
        const std::uint64_t found = length();
        if (found != size) throw InputError("saved lists that belong together have different lengths");
        fill(values, found);
    }
    /// Reads a list that has `size` entries or none. Throws InputError for other lengths.
    template <class T>
    requires kIsFlat<T>
    void all_or_none(std::vector<T>& values, std::size_t size, const T& absent) {
        static_cast<void>(absent);
        const std::uint64_t found = length();
        if (found != 0 && found != size) throw InputError("saved lists that belong together have different lengths");
        fill(values, found);
    }
    void operator()(std::string& text) { fill(text, length()); }

private:
    /// Number of bytes by which a list grows at a time while it is read.
    static constexpr std::size_t kPiece = std::size_t{1} << 20;

    [[nodiscard]] std::uint64_t length() {
        std::uint64_t count = 0;
        (*this)(count);
        return count;
    }
    template <class List>
    void fill(List& list, std::uint64_t size) {
        constexpr std::size_t kEntries = std::max<std::size_t>(1, kPiece / sizeof(typename List::value_type));
        list.clear();
        while (list.size() < size) {
            const std::size_t first = list.size();
            list.resize(static_cast<std::size_t>(std::min<std::uint64_t>(size, first + kEntries)));
            source_(std::as_writable_bytes(std::span(list).subspan(first)));
        }
    }

    ByteSource source_;
};

/// Expected length in archive_entries() with which every length is accepted.
inline constexpr std::uint64_t kAnyLength = ~std::uint64_t{0};

/// Saves or restores a list whose entries are not flat, by calling visit(entry) for each. Throws InputError when
/// reading if the list does not have the expected length.
template <class Archive, class T, class Visit>
void archive_entries(Archive& a, std::vector<T>& entries, const Visit& visit, std::uint64_t expected = kAnyLength) {
    auto count = static_cast<std::uint64_t>(entries.size());
    a(count);
    if constexpr (Archive::kReads) {
        if (expected != kAnyLength && count != expected) {
            throw InputError("saved lists that belong together have different lengths");
        }
        entries.clear();
        for (std::uint64_t k = 0; k < count; ++k) visit(entries.emplace_back());
    } else {
        for (T& entry : entries) visit(entry);
    }
}

}  // namespace ricochet
