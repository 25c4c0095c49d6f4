#include "view/page/page_reader.h"

#include <zlib.h>

#include <cstring>
#include <stdexcept>

namespace ricochet::test {
namespace {

std::string bytes_of(std::string_view text) {
    static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=') break;
        const std::size_t digit = kDigits.find(c);
        if (digit == std::string_view::npos) throw std::runtime_error("no base64");
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes += static_cast<char>(bits >> count & 255U);
        }
    }
    return bytes;
}

// Reads the ids of the rows, ascending: the ids of the frame before without the removed ones, and the new ones.
std::vector<std::int64_t> read_ids(PageBytes& in, const std::vector<std::int64_t>& before, RowHistory& rows) {
    std::vector<bool> is_gone(before.size(), false);
    const std::uint64_t gone = in.varint();
    std::uint64_t row = 0;
    for (std::uint64_t i = 0; i < gone; ++i, ++row) is_gone.at(row += in.varint()) = true;
    std::vector<std::pair<std::int64_t, std::uint32_t>> now;
    for (std::uint32_t k = 0; k < before.size(); ++k) {
        if (!is_gone[k]) now.emplace_back(before[k], k);
    }
    const std::uint64_t born = in.varint();
    std::int64_t id = 0;
    for (std::uint64_t i = 0; i < born; ++i, ++id) {
        id += static_cast<std::int64_t>(in.varint());
        now.emplace_back(id, RowHistory::kNew);
    }
    std::sort(now.begin(), now.end());
    std::vector<std::int64_t> ids;
    std::vector<std::uint32_t> parents;
    for (const auto& [its_id, parent] : now) {
        ids.push_back(its_id);
        parents.push_back(parent);
    }
    rows.follow(parents);
    return ids;
}

std::vector<std::uint32_t> read_cells(PageBytes& in, std::size_t corners) {
    std::vector<std::uint32_t> cells;
    std::int64_t corner = 0;
    for (std::uint64_t count = corners * in.varint(); count > 0; --count) {
        corner += in.signed_varint();
        cells.push_back(static_cast<std::uint32_t>(corner));
    }
    return cells;
}

}  // namespace

std::string unpacked(std::string_view text) {
    const std::string packed = bytes_of(text);
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) throw std::runtime_error("no zlib");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    std::string bytes;
    int status = Z_OK;
    while (status == Z_OK) {
        std::array<char, 65536> part{};
        stream.next_out = reinterpret_cast<Bytef*>(part.data());
        stream.avail_out = part.size();
        status = inflate(&stream, Z_NO_FLUSH);
        bytes.append(part.data(), part.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    if (status != Z_STREAM_END) throw std::runtime_error("no deflated bytes");
    return bytes;
}

std::uint8_t PageBytes::byte() { return static_cast<std::uint8_t>(bytes_.at(at_++)); }

std::uint64_t PageBytes::varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0;; shift += 7) {
        const std::uint8_t part = byte();
        value |= static_cast<std::uint64_t>(part & 127U) << shift;
        if (part < 128) return value;
    }
}

std::int64_t PageBytes::signed_varint() {
    const std::uint64_t counted = varint();
    return counted % 2 == 0 ? static_cast<std::int64_t>(counted / 2) : -static_cast<std::int64_t>(counted / 2) - 1;
}

float PageBytes::float32() {
    std::array<std::uint8_t, 4> bytes{};
    for (std::uint8_t& part : bytes) part = byte();
    float value = 0.0F;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
}

Levels PageChannel::decode(PageBytes& in, const RowHistory& rows) {
    const std::size_t count = rows.parent.size();
    std::array<Levels, 3> past;
    for (std::size_t k = 0; k < 3; ++k) {
        past[k].assign(count, 0);
        for (std::size_t row = 0; row < count; ++row) {
            if (rows.parent[row] < past_[k].size()) past[k][row] = past_[k][rows.parent[row]];
        }
    }
    const int order = in.byte();
    std::vector<unsigned> counted(count);
    for (unsigned& value : counted) value = in.byte();
    for (std::size_t row = 0; bits_ > 8 && row < count; ++row) counted[row] |= static_cast<unsigned>(in.byte()) << 8U;
    Levels values(count);
    for (std::size_t row = 0; row < count; ++row) {
        const int difference =
            counted[row] % 2 == 0 ? static_cast<int>(counted[row] / 2) : -static_cast<int>(counted[row] / 2) - 1;
        const int used = std::min<int>(rows.known[row], order + 1);
        int expected = row == 0 ? 0 : values[row - 1];
        if (used == 1) expected = past[0][row];
        if (used == 2) expected = 2 * past[0][row] - past[1][row];
        if (used == 3) expected = 3 * past[0][row] - 3 * past[1][row] + past[2][row];
        values[row] = static_cast<std::uint16_t>((expected + difference) & ((1 << bits_) - 1));
    }
    past_ = {values, past[0], past[1]};
    return values;
}

ReadPage::ReadPage(std::string page) : text(std::move(page)) {
    const std::string start = "<script type=\"application/json\" id=\"description\">";
    const std::size_t begin = text.find(start) + start.size();
    description = nlohmann::json::parse(text.substr(begin, text.find("</script>", begin) - begin));
    read_frames();
}

PageBytes ReadPage::block(const std::string& name) const {
    const std::string start = "data-block=\"" + name + "\">";
    const std::size_t found = text.find(start);
    if (found == std::string::npos) throw std::runtime_error("no block " + name);
    const std::size_t begin = found + start.size();
    return PageBytes(unpacked(std::string_view(text).substr(begin, text.find('<', begin) - begin)));
}

void ReadPage::read_frames() {
    std::vector<PageChannel> channels(3, PageChannel(description.at("positionBits")));
    for (const auto& attribute : description.at("attributes")) {
        if (!attribute.at("constant")) channels.emplace_back(attribute.at("bits").get<int>());
    }
    if (description.at("colors")) channels.insert(channels.end(), 3, PageChannel(8));
    std::size_t rigid = 0;
    std::vector<RowHistory> deforming;
    for (const auto& part : description.at("parts")) {
        rigid += part.at("motion") == "rigid" ? 1 : 0;
        if (part.at("motion") == "deforming") deforming.emplace_back();
    }
    std::vector<PageChannel> axes(3 * deforming.size(), PageChannel(description.at("positionBits")));
    RowHistory rows;
    for (std::size_t i = 0; i < description.at("frames").at("count").size(); ++i) {
        PageBytes in = block("frame" + std::to_string(i));
        ReadFrame frame;
        frame.ids = read_ids(in, frames.empty() ? std::vector<std::int64_t>() : frames.back().ids, rows);
        for (PageChannel& channel : channels) frame.channels.push_back(channel.decode(in, rows));
        const int springs = in.byte();
        if (springs == 1) frame.lines = frames.back().lines, frame.triangles = frames.back().triangles;
        if (springs == 2) frame.lines = read_cells(in, 2), frame.triangles = read_cells(in, 3);
        frame.poses.resize(rigid);
        for (auto& pose : frame.poses) {
            for (float& number : pose) number = in.float32();
        }
        std::size_t d = 0;
        for (const auto& part : description.at("parts")) {
            if (part.at("motion") != "deforming") continue;
            deforming[d].follow_same(part.at("vertices"));
            auto& points = frame.points.emplace_back();
            for (std::size_t axis = 0; axis < 3; ++axis) points[axis] = axes[3 * d + axis].decode(in, deforming[d]);
            ++d;
        }
        if (!in.is_at_end()) throw std::runtime_error("bytes are left in a frame");
        frames.push_back(std::move(frame));
    }
}

std::array<double, 3> ReadPage::position(const ReadFrame& frame, std::size_t row) const {
    const auto& grid = description.at("grid");
    std::array<double, 3> place{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        place[axis] = description.at("origin")[axis].get<double>() + grid.at("lower")[axis].get<double>() +
                      grid.at("step").get<double>() * frame.channels[axis][row];
    }
    return place;
}

std::size_t ReadPage::attribute(const std::string& name) const {
    for (std::size_t i = 0; i < description.at("attributes").size(); ++i) {
        if (description.at("attributes")[i].at("name") == name) return i;
    }
    throw std::runtime_error("no attribute " + name);
}

double ReadPage::value(const ReadFrame& frame, const std::string& name, std::size_t row) const {
    const std::size_t wanted = attribute(name);
    std::size_t channel = 3;
    for (std::size_t i = 0; i < wanted; ++i) channel += description.at("attributes")[i].at("constant") ? 0 : 1;
    const auto& told = description.at("attributes")[wanted];
    if (told.at("constant")) return told.at("low");
    return told.at("low").get<double>() + told.at("step").get<double>() * frame.channels[channel][row];
}

}  // namespace ricochet::test
