/// \file
/// How bytes get into a page: gathered, deflated, and as text.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace ricochet {

/// Gathers numbers, little endian.
class ByteWriter {
public:
    void byte(std::uint8_t value) { bytes_.push_back(static_cast<char>(value)); }
    /// Seven bits a byte, the lowest first; all but the last byte have their top bit set.
    void varint(std::uint64_t value) {
        for (; value >= 0x80; value >>= 7) byte(static_cast<std::uint8_t>(value | 0x80U));
        byte(static_cast<std::uint8_t>(value));
    }
    /// A number of either sign: 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
    void signed_varint(std::int64_t value) {
        varint((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
    }
    void float32(double value) {
        const auto narrow = static_cast<float>(value);
        std::array<char, sizeof narrow> bytes{};
        std::memcpy(bytes.data(), &narrow, sizeof narrow);
        bytes_.append(bytes.data(), bytes.size());
    }
    void append(std::string_view bytes) { bytes_ += bytes; }

    [[nodiscard]] const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
};

/// The bytes in zlib's format (RFC 1950), which browsers unpack as `deflate`. Throws std::bad_alloc.
[[nodiscard]] std::string deflated(std::string_view bytes);

/// The bytes as text (RFC 4648, with padding).
[[nodiscard]] std::string base64(std::string_view bytes);

/// Text between tags: &, <, > and quotes as entities.
[[nodiscard]] std::string html_text(std::string_view text);

}  // namespace ricochet
