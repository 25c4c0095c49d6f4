#include "run/csv_file.h"

#include <fmt/format.h>

#include <iterator>

namespace ricochet {

std::string csv_field(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

CsvFile::CsvFile(const std::filesystem::path& path, std::string_view header) : file_(path), text_(header) {
    text_ += '\n';
}

void CsvFile::begin_field() {
    if (is_in_row_) text_ += ',';
    is_in_row_ = true;
}

// Writes the shortest text that reads back as the same double. Whole numbers get a decimal point. Otherwise readers
// would parse the column as integers and lose the sign of -0.
void CsvFile::add(double value) {
    begin_field();
    const std::size_t begin = text_.size();
    fmt::format_to(std::back_inserter(text_), "{}", value);
    if (std::string_view(text_).substr(begin).find_first_not_of("-0123456789") == std::string_view::npos) {
        text_ += ".0";
    }
}

void CsvFile::add(const Vec3& value) { add(value.x), add(value.y), add(value.z); }

void CsvFile::add(std::int64_t value) {
    begin_field();
    fmt::format_to(std::back_inserter(text_), "{}", value);
}

void CsvFile::add(std::string_view text) {
    begin_field();
    text_ += csv_field(text);
}

void CsvFile::skip(int fields) {
    for (int k = 0; k < fields; ++k) begin_field();
}

void CsvFile::end_row() {
    constexpr std::size_t kFlushBytes = std::size_t{1} << 16;
    text_ += '\n';
    is_in_row_ = false;
    if (text_.size() < kFlushBytes) return;
    file_.write(text_);
    text_.clear();
}

void CsvFile::commit() {
    file_.write(text_);
    file_.commit();
}

}  // namespace ricochet
