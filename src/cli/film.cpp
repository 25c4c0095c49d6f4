#include "cli/film.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves the declaration to the program

namespace ricochet::cli {

namespace {

std::vector<std::string> ffmpeg_arguments(const std::filesystem::path& output, int width, int height, int rate) {
    return {"ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-y",
            // input: raw pictures on standard input
            "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", fmt::format("{}x{}", width, height),
            "-framerate", std::to_string(rate), "-i", "pipe:0",
            // output: a format that every player supports
            "-c:v", "libx264", "-preset", "medium", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags", "+faststart",
            "-f", "mp4", "file:" + output.string()};
}

std::uint64_t big_endian(const unsigned char* bytes, std::size_t count) {
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < count; ++k) value = value << 8U | bytes[k];
    return value;
}

/// Returns true if an MP4 file is complete. Its boxes must fill the file exactly, and one box must be the index
/// (`moov`); see ISO/IEC 14496-12, section 4.2. Reason: some releases of ffmpeg return exit code 0 although writing to
/// the disk failed.
bool is_whole_film(const std::filesystem::path& file) {
    std::error_code error;
    const std::uint64_t size = std::filesystem::file_size(file, error);
    std::ifstream in(file, std::ios::binary);
    if (error || !in) return false;
    bool has_index = false;
    std::uint64_t at = 0;
    while (at < size) {
        std::array<unsigned char, 16> head{};
        in.seekg(static_cast<std::streamoff>(at));
        in.read(reinterpret_cast<char*>(head.data()), head.size());
        const auto got = static_cast<std::size_t>(in.gcount());
        in.clear();
        if (got < 8) return false;
        const std::uint64_t short_size = big_endian(head.data(), 4);
        const bool is_long = short_size == 1;
        const std::uint64_t box = is_long ? big_endian(head.data() + 8, 8) : short_size;
        if (box < (is_long ? 16U : 8U) || box > size - at) return false;
        has_index = has_index || std::memcmp(head.data() + 4, "moov", 4) == 0;
        at += box;
    }
    return has_index;
}

std::filesystem::path temporary_name(std::filesystem::path target) {
    return target += fmt::format(".{}.partial", ::getpid());
}

}  // namespace

Film::Film(std::filesystem::path target, int width, int height, int frames_per_second)
    : target_(std::move(target)), temporary_(temporary_name(target_)), unfinished_(temporary_) {
    (void)std::signal(SIGPIPE, SIG_IGN);  // if ffmpeg has ended, write() then returns an error
    messages_ = std::tmpfile();
    if (messages_ == nullptr) throw RunError(fmt::format("no temporary file for ffmpeg ({})", std::strerror(errno)));
    start(width, height, frames_per_second);
}

void Film::start(int width, int height, int frames_per_second) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        throw RunError(fmt::format("no pipe for ffmpeg ({})", std::strerror(errno)));
    std::vector<std::string> arguments = ffmpeg_arguments(temporary_, width, height, frames_per_second);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ::fileno(messages_), STDERR_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);  // a group of its own: Ctrl-C must reach only this
                                                                   // process, which then ends ffmpeg
    const int error = ::posix_spawnp(&process_, "ffmpeg", &actions, &attributes, pointers.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[0]);
    pipe_ = ends[1];
    if (error == 0) {
        unfinished_.set_writer(process_);
        return;
    }
    ::close(pipe_);
    (void)std::fclose(messages_);
    throw RunError(fmt::format("{}: ffmpeg cannot be started ({}); install ffmpeg, or give --output a .png name",
                               target_.string(), std::strerror(error)));
}

Film::~Film() {
    if (pipe_ >= 0) ::close(pipe_);
    if (process_ > 0) {
        (void)::kill(process_, SIGKILL);
        (void)wait();
    }
    (void)std::fclose(messages_);
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
}

int Film::wait() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
    process_ = -1;
    unfinished_.set_writer(0);
    return status;
}

void Film::fail() {
    if (pipe_ >= 0) ::close(std::exchange(pipe_, -1));
    if (process_ > 0) (void)wait();
    std::array<char, 400> text{};
    std::rewind(messages_);
    const char* line = std::fgets(text.data(), static_cast<int>(text.size()), messages_);
    std::string said = line == nullptr ? "it said nothing" : line;
    while (!said.empty() && said.back() == '\n') said.pop_back();
    throw RunError(fmt::format("{}: ffmpeg failed: {}", target_.string(), said));
}

void Film::add(const Image& image) {
    std::size_t written = 0;
    while (written < image.rgb.size()) {
        const ssize_t count = ::write(pipe_, image.rgb.data() + written, image.rgb.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail();
        written += static_cast<std::size_t>(count);
    }
}

void Film::finish() {
    ::close(std::exchange(pipe_, -1));
    if (wait() != 0 || !is_whole_film(temporary_)) fail();
    std::error_code error;
    std::filesystem::rename(temporary_, target_, error);
    if (error) throw RunError(fmt::format("{}: cannot name the film ({})", target_.string(), error.message()));
}

}  // namespace ricochet::cli
