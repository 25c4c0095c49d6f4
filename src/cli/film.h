// A film from pictures, through the ffmpeg program.
#pragma once

#include <cstdio>
#include <filesystem>

#include "ricochet/core/unfinished_file.h"
#include "view/render/image.h"

namespace ricochet::cli {

/// Feeds pictures to ffmpeg, which writes an H.264 film. The film appears under its name when finish() has been called;
/// without it nothing is left behind.
class Film {
public:
    /// What ffmpeg holds of pictures that it compares, bytes a pixel; measured.
    static constexpr double kBytesPerPixel = 200.0;

    /// Throws RunError when ffmpeg is not installed. width and height must be even.
    Film(std::filesystem::path target, int width, int height, int frames_per_second);
    ~Film();
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;

    /// Throws RunError with ffmpeg's own words when it has given up.
    void add(const Image& image);
    void finish();

private:
    void start(int width, int height, int frames_per_second);
    int wait();
    [[noreturn]] void fail();

    std::filesystem::path target_;
    std::filesystem::path temporary_;
    UnfinishedFile unfinished_;
    std::FILE* messages_ = nullptr;  // what ffmpeg says on stderr
    int pipe_ = -1;
    int process_ = -1;
};

}  // namespace ricochet::cli
