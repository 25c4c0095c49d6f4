/// \file
/// Reads pages as their scripts do. Written from the description of the format alone.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "view/page/channel_encoder.h"

namespace ricochet::test {

/// Decodes a text in base64 and inflates it. Throws std::runtime_error if the text is malformed.
[[nodiscard]] std::string unpacked(std::string_view text);

class PageBytes {
public:
    explicit PageBytes(std::string bytes) : bytes_(std::move(bytes)) {}
    /// All readers throw std::out_of_range past the end.
    std::uint8_t byte();
    std::uint64_t varint();
    std::int64_t signed_varint();
    float float32();
    [[nodiscard]] bool is_at_end() const { return at_ == bytes_.size(); }

private:
    std::string bytes_;
    std::size_t at_ = 0;
};

class PageChannel {
public:
    explicit PageChannel(int bits) : bits_(bits) {}
    Levels decode(PageBytes& in, const RowHistory& rows);

private:
    int bits_;
    std::array<Levels, 3> past_;
};

/// One frame of a page.
struct ReadFrame {
    std::vector<std::int64_t> ids;
    std::vector<Levels> channels;
    std::vector<std::uint32_t> lines;
    std::vector<std::uint32_t> triangles;
    std::vector<std::array<float, 12>> poses;
    std::vector<std::array<Levels, 3>> points;
};

/// A page, read from its text.
struct ReadPage {
    std::string text;
    nlohmann::json description;
    std::vector<ReadFrame> frames;

    explicit ReadPage(std::string page);
    /// Returns the unpacked text of the block with this name.
    [[nodiscard]] PageBytes block(const std::string& name) const;
    /// Returns the world coordinates of a particle, in m.
    [[nodiscard]] std::array<double, 3> position(const ReadFrame& frame, std::size_t row) const;
    [[nodiscard]] std::size_t attribute(const std::string& name) const;
    [[nodiscard]] double value(const ReadFrame& frame, const std::string& name, std::size_t row) const;

private:
    void read_frames();
};

}  // namespace ricochet::test
