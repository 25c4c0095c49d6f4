// A film from pictures, encoded by the ffmpeg program.
#pragma once

#include <cstdio>
#include <filesystem>

#include "ricochet/core/unfinished_file.h"
#include "view/render/image.h"

namespace ricochet::cli {

/// Pipes pictures to ffmpeg, which writes an H.264 film. The film appears under its name after finish(). Without
/// finish(), no file remains.
class Film {
public:
    /// Measured memory of ffmpeg for the pictures that it compares while encoding, in bytes per pixel.
    static constexpr double kBytesPerPixel = 200.0;

    /// Throws RunError if ffmpeg is not installed. width and height must be even.
    Film(std::filesystem::path target, int width, int height, int frames_per_second);
    ~Film();
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;

    /// Appends a picture. Throws RunError with ffmpeg's message if ffmpeg has failed.
    void add(const Image& image);
    void finish();

private:
    void start(int width, int height, int frames_per_second);
    int wait();
    [[noreturn]] void fail();

    std::filesystem::path target_;
    std::filesystem::path temporary_;
    UnfinishedFile unfinished_;
    std::FILE* messages_ = nullptr;  // ffmpeg's standard error
    int pipe_ = -1;
    int process_ = -1;
};

}  // namespace ricochet::cli
