// Values of options that are more than one number.
#pragma once

#include <string>
#include <vector>

namespace ricochet::cli {

/// The numbers of a comma-separated list. Throws InputError, naming the option, when one is no finite number.
[[nodiscard]] std::vector<double> parse_number_list(const std::string& option, const std::string& text);

struct PictureSize {
    int width = 0;
    int height = 0;
};
/// WIDTHxHEIGHT, each 1..16384. Throws InputError.
[[nodiscard]] PictureSize parse_picture_size(const std::string& text);

/// A number of worker threads, 1..1024; 0 (all) for an empty text. Throws InputError.
[[nodiscard]] int parse_thread_count(const std::string& text);

}  // namespace ricochet::cli
