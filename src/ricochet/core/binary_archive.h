/// \file
/// Values as bytes and back, for states that are saved and resumed on one kind of machine.
#pragma once

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

/// Types that are saved as they are in memory: without pointers and padding.
template <class T>
inline constexpr bool kIsFlat = std::is_arithmetic_v<T> || std::is_enum_v<T>;  // std::byte is an enumeration
template <>
inline constexpr bool kIsFlat<Vec3> = true;
template <class T, std::size_t n>
inline constexpr bool kIsFlat<std::array<T, n>> = kIsFlat<T>;

/// Writes. One function template over both archives, archive(x.member) for every member, saves and restores a type.
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
    void operator()(const std::string& text) {
        (*this)(static_cast<std::uint64_t>(text.size()));
        if (!text.empty()) sink_(std::as_bytes(std::span(text)));
    }

private:
    ByteSink sink_;
};

/// Reads what a BinaryWriter has written, in the same order.
class BinaryReader {
public:
    static constexpr bool kReads = true;
    /// Longest list, entries: a damaged length must not exhaust the memory.
    static constexpr std::uint64_t kLongestList = std::uint64_t{1} << 34;

    explicit BinaryReader(ByteSource source) : source_(std::move(source)) {}

    template <class T>
    requires kIsFlat<T>
    void operator()(T& value) { source_(std::as_writable_bytes(std::span(&value, 1))); }
    template <class T>
    requires kIsFlat<T>
    void operator()(std::vector<T>& values) {
        values.resize(length());
        if (!values.empty()) source_(std::as_writable_bytes(std::span(values)));
    }
    void operator()(std::string& text) {
        text.resize(length());
        if (!text.empty()) source_(std::as_writable_bytes(std::span(text)));
    }

private:
    [[nodiscard]] std::size_t length() {
        std::uint64_t count = 0;
        (*this)(count);
        if (count > kLongestList) throw InputError("a saved list is longer than any can be");
        return static_cast<std::size_t>(count);
    }

    ByteSource source_;
};

}  // namespace ricochet
