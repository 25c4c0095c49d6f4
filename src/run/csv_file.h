/// \file
/// Tables of comma-separated values (RFC 4180) whose numbers read back as the same doubles.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Returns a text as a field of a table, quoted if necessary.
[[nodiscard]] std::string csv_field(std::string_view text);

/// A table that is written row by row. The file appears under its name only when it is complete.
class CsvFile {
public:
    /// header: names of the columns, already quoted if necessary. Throws like AtomicFile.
    CsvFile(const std::filesystem::path& path, std::string_view header);

    // Each overload adds one field to the row; a vector adds three.
    void add(double value);
    void add(const Vec3& value);
    void add(std::int64_t value);
    void add(std::uint32_t value) { add(std::int64_t{value}); }
    void add(std::uint8_t value) { add(std::int64_t{value}); }
    void add(std::string_view text);
    /// Adds empty fields.
    void skip(int fields);
    /// Ends the row. Throws RunError if writing fails.
    void end_row();
    /// Renames the complete file to its final name. Call it once, at the end. Throws RunError if renaming fails.
    void commit();

private:
    void begin_field();

    AtomicFile file_;
    std::string text_;
    bool is_in_row_ = false;
};

}  // namespace ricochet
