#include "lab/compare/gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <list>
#include <system_error>
#include <thread>

#include "ricochet/core/unfinished_file.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves the declaration to the program

namespace ricochet {

namespace {

// Colours that colour-blind readers can distinguish (M. Okabe, K. Ito, "Color universal design", 2008).
constexpr std::array kColors{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000"};
constexpr std::array kPointTypes{7, 5, 9, 13, 3};
constexpr std::array kPointSizes{2.2, 1.7, 1.7, 1.7, 1.4};

}  // namespace

std::string gnuplot_start(std::string_view remark) {
    return fmt::format("# {}\n", remark) +
           "if (!exists('ending')) ending = ''\n"
           "if (strstrt(GPVAL_TERMINALS, 'pngcairo') > 0) {\n"
           "    set terminal pngcairo size 1100,700 font 'DejaVu Sans,14' background 'white'\n"
           "} else {\n"
           "    set terminal png size 1100,700\n"
           "}\n"
           "set encoding utf8\n"
           "set datafile missing 'nan'\n"
           "set grid linetype 1 linecolor '#c8c8c8' linewidth 1\n"
           "set border linecolor '#404040'\n"
           "set key outside right top Left reverse noenhanced\n"
           "set tics nomirror\n"
           "set format y '%g'\n";
}

std::string gnuplot_line_styles(std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t k = i % kColors.size();
        text += fmt::format("set style line {} linecolor '{}' linewidth 2 pointtype {} pointsize {}\n", i + 1,
                            kColors[k], kPointTypes[k], kPointSizes[k]);
    }
    return text;
}

namespace {

constexpr auto kPause = std::chrono::milliseconds(20);  // time between two checks whether gnuplot has ended

// Returns true if a file ends with the last chunk of a PNG picture. The exit code of gnuplot does not suffice, because
// it can be 0 even if a full disk truncated the picture.
bool is_whole_png(const std::filesystem::path& file) {
    constexpr std::string_view kEnd("\0\0\0\0IEND\xAE\x42\x60\x82", 12);
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    if (!in || in.tellg() < static_cast<std::streamoff>(kEnd.size())) return false;
    std::string end(kEnd.size(), '\0');
    in.seekg(-static_cast<std::streamoff>(kEnd.size()), std::ios::end);
    in.read(end.data(), static_cast<std::streamsize>(end.size()));
    return in && end == kEnd;
}

// Unfinished pictures of a script. The destructor removes the pictures that have not been renamed.
class UnfinishedPictures {
public:
    UnfinishedPictures(std::filesystem::path folder, const std::vector<std::string>& names)
        : folder_(std::move(folder)), names_(names), ending_(fmt::format(".{}-0.partial", ::getpid())) {
        for (const std::string& name : names_) noted_.emplace_back(folder_ / (name + ending_));
    }
    ~UnfinishedPictures() {
        for (const std::string& name : names_) {
            std::error_code ignored;
            std::filesystem::remove(folder_ / (name + ending_), ignored);
        }
    }
    UnfinishedPictures(const UnfinishedPictures&) = delete;
    UnfinishedPictures& operator=(const UnfinishedPictures&) = delete;

    [[nodiscard]] const std::string& ending() const { return ending_; }
    void set_writer(pid_t process) {
        for (UnfinishedFile& file : noted_) file.set_writer(process);
    }

    // Renames the pictures to their final names. Returns false if a picture is missing or incomplete, or cannot be
    // renamed.
    [[nodiscard]] bool finish() const {
        for (const std::string& name : names_) {
            if (!is_whole_png(folder_ / (name + ending_))) return false;
        }
        for (const std::string& name : names_) {
            std::error_code error;
            std::filesystem::rename(folder_ / (name + ending_), folder_ / name, error);
            if (error) return false;
        }
        return true;
    }

private:
    std::filesystem::path folder_;
    const std::vector<std::string>& names_;
    std::string ending_;
    std::list<UnfinishedFile> noted_;
};

// Starts gnuplot in the folder, with its error messages redirected to a file. Returns 0 or an errno value.
int start(pid_t& process, const std::filesystem::path& folder, std::vector<std::string> arguments,
          std::FILE* messages) {
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ::fileno(messages), STDERR_FILENO);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    // Gnuplot gets its own process group, so that Ctrl-C reaches only this process, which then stops gnuplot.
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int error = ::posix_spawnp(&process, "gnuplot", &actions, &attributes, pointers.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

// Returns the exit status, or -1 if the process was stopped or the wait failed.
int wait_for(pid_t process, const std::function<bool()>& should_stop) {
    int status = 0;
    while (true) {
        const pid_t ended = ::waitpid(process, &status, WNOHANG);
        if (ended == process) return status;
        if (ended < 0 && errno != EINTR) return -1;
        if (should_stop()) {
            (void)::kill(process, SIGKILL);
            (void)::waitpid(process, &status, 0);
            return -1;
        }
        std::this_thread::sleep_for(kPause);
    }
}

int draw_to_the_end(pid_t process, const std::function<bool()>& should_stop, UnfinishedPictures& unfinished) {
    unfinished.set_writer(process);
    const int status = wait_for(process, should_stop);
    unfinished.set_writer(0);
    return status;
}

// Returns the first line with an error message ("line N: ..."), otherwise the first line. Lines before the message show
// only the location in the script.
std::string first_words(std::FILE* messages) {
    std::array<char, 400> line{};
    std::rewind(messages);
    std::string first;
    while (std::fgets(line.data(), static_cast<int>(line.size()), messages) != nullptr) {
        std::string text = line.data();
        while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
        if (text.find("line ") != std::string::npos && text.find(": ") != std::string::npos) return text;
        if (first.empty()) first = text;
    }
    return first.empty() ? "no error message" : first;
}

}  // namespace

std::string draw_with_gnuplot(const std::filesystem::path& folder, const std::string& script,
                              const std::vector<std::string>& pictures, const std::function<bool()>& should_stop) {
    std::FILE* const messages = std::tmpfile();
    if (messages == nullptr) return fmt::format("no temporary file for gnuplot ({})", std::strerror(errno));
    UnfinishedPictures unfinished(folder, pictures);
    pid_t process = -1;
    std::string failure;
    const std::string set_ending = fmt::format("ending = '{}'", unfinished.ending());
    if (const int error = start(process, folder, {"gnuplot", "-e", set_ending, script}, messages); error != 0) {
        failure = fmt::format("gnuplot cannot be started ({})", std::strerror(error));
    } else if (draw_to_the_end(process, should_stop, unfinished) != 0) {
        failure = should_stop() ? "gnuplot was stopped" : fmt::format("gnuplot failed: {}", first_words(messages));
    } else if (!unfinished.finish()) {
        failure = "gnuplot has not written all pictures";
    }
    (void)std::fclose(messages);
    return failure;
}

}  // namespace ricochet
