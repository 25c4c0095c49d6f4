#include "lab/study/study_processes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <system_error>
#include <thread>
#include <utility>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"
#include "ricochet/core/printable.h"
#include "ricochet/core/unfinished_file.h"
#include "run/run_folder.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves the declaration to the program

namespace ricochet {
namespace {

constexpr auto kPause = std::chrono::milliseconds(10);  // time between two looks at the processes

constexpr const char* kArgumentsFile = "study_run.txt";  // arguments of a run, in the folder of the study
constexpr const char* kMessagesFile = "messages.txt";    // output of a run

std::string content_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Runs the processes of a study.
class StudyRunner {
public:
    StudyRunner(const StudyPlan& plan, const std::vector<StudyRun>& runs, const StudyProcesses& processes)
        : plan_(plan), runs_(runs), processes_(processes), outcomes_(runs.size()) {
        scene_ = content_of(plan.scene);
    }

    std::vector<StudyOutcome> run(const std::function<bool(const StudyProgress&)>& should_stop) {
        std::size_t next = 0;
        bool is_stopped = false;
        while (next < runs_.size() || !running_.empty()) {
            while (!is_stopped && next < runs_.size() && running_.size() < processes_.at_a_time) begin(next++);
            if (is_stopped) next = std::max(next, runs_.size());
            wait_for_some();
            if (!is_stopped && (!missing_.empty() || should_stop({finished_, failed_, runs_.size()}))) {
                is_stopped = true;
                for (std::size_t k = next; k < runs_.size(); ++k) outcomes_[k].failure = "not run";
                for (const Process& process : running_) (void)::kill(process.id, SIGTERM);
            }
        }
        if (!missing_.empty()) {
            throw InputError(
                fmt::format("results: summary.json of a run has no number \"{}\", expected a path such as "
                            "contacts or counters.NAME.forward",
                            missing_));
        }
        (void)should_stop({finished_, failed_, runs_.size()});
        return std::move(outcomes_);
    }

private:
    struct Process {
        pid_t id = -1;
        std::size_t run = 0;
        std::unique_ptr<UnfinishedFile> messages;  // a signal that ends this process kills the run, too
    };

    /// Returns the text that a run depends on: its arguments, and the scene file.
    [[nodiscard]] std::string signature(const StudyRun& run) const {
        StateHash hash;
        hash.add(std::as_bytes(std::span(scene_)));
        std::string text = fmt::format("scene {:016x}\n", hash.value());
        for (const std::string& override_text : run.overrides) text += override_text + "\n";
        return text;
    }
    [[nodiscard]] std::filesystem::path beside(const StudyRun& run, const char* name) const {
        return processes_.folder / fmt::format("run_{:04}.{}", run.number, name);
    }

    /// Begins a run, unless its results are there.
    void begin(std::size_t k) {
        const StudyRun& run = runs_[k];
        const std::filesystem::path folder = folder_of(processes_, run);
        const bool is_known = content_of(beside(run, kArgumentsFile)) == signature(run);
        if (is_known && is_finished(folder)) return finish(k, 0);
        const bool resumes = is_known && std::filesystem::exists(folder / kCheckpointFile);
        if (!is_known) write_file(beside(run, kArgumentsFile), signature(run));
        start(k, resumes);
    }

    [[nodiscard]] static bool is_finished(const std::filesystem::path& folder) {
        return number_in_summary(content_of(folder / kSummaryFile), "interrupted") == std::optional(0.0);
    }

    void start(std::size_t k, bool resumes) {
        const StudyRun& run = runs_[k];
        std::vector<std::string> words{processes_.program,
                                       "run",
                                       plan_.scene.string(),
                                       "--output",
                                       folder_of(processes_, run).string(),
                                       "--threads",
                                       std::to_string(processes_.threads),
                                       "--quiet"};
        if (resumes) words.emplace_back("--resume");
        for (const std::string& override_text : run.overrides) words.insert(words.end(), {"--set", override_text});
        std::vector<char*> pointers;
        for (std::string& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, beside(run, kMessagesFile).c_str(),
                                         O_WRONLY | O_CREAT | O_TRUNC, 0644);
        posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        // A process group of its own, so that Ctrl-C reaches only this process, which then asks the runs to end.
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
        Process process{-1, k, std::make_unique<UnfinishedFile>(beside(run, kMessagesFile))};
        const int error =
            ::posix_spawn(&process.id, processes_.program.c_str(), &actions, &attributes, pointers.data(), environ);
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&actions);
        if (error != 0) {
            throw RunError(fmt::format("study: {} cannot be started ({})", processes_.program, std::strerror(error)));
        }
        process.messages->set_writer(process.id);
        running_.push_back(std::move(process));
    }

    void wait_for_some() {
        bool has_ended = false;
        for (std::size_t i = 0; i < running_.size();) {
            int status = 0;
            const pid_t ended = ::waitpid(running_[i].id, &status, WNOHANG);
            if (ended == 0 || (ended < 0 && errno == EINTR)) {
                ++i;
                continue;
            }
            has_ended = true;
            running_[i].messages->set_writer(0);
            const std::size_t run = running_[i].run;
            running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
            finish(run, ended < 0 ? -1 : status);
        }
        if (!has_ended && !running_.empty()) std::this_thread::sleep_for(kPause);
    }

    /// Reads the results of a run that has ended.
    void finish(std::size_t k, int status) {
        StudyOutcome& outcome = outcomes_[k];
        outcome.failure = failure_of(runs_[k], status);
        const std::string summary = content_of(folder_of(processes_, runs_[k]) / kSummaryFile);
        for (const std::string& path : plan_.results) {
            if (!outcome.failure.empty()) break;
            const std::optional<double> number = number_in_summary(summary, path);
            if (!number && missing_.empty()) missing_ = path;
            outcome.results.push_back(number.value_or(0.0));
        }
        if (!outcome.failure.empty()) outcome.results.clear();
        ++finished_;
        if (!outcome.failure.empty()) ++failed_;
    }

    /// Returns the reason why a process failed, or an empty text.
    [[nodiscard]] std::string failure_of(const StudyRun& run, int status) const {
        if (status == 0) return is_finished(folder_of(processes_, run)) ? "" : "the run wrote no summary";
        const std::string messages = content_of(beside(run, kMessagesFile));
        std::string line = messages.substr(0, messages.find('\n'));
        if (!line.empty()) return printable(line);
        if (WIFSIGNALED(status)) return fmt::format("ended by signal {}", WTERMSIG(status));
        return WIFEXITED(status) ? fmt::format("exit code {}", WEXITSTATUS(status)) : "the process was lost";
    }

    const StudyPlan& plan_;
    const std::vector<StudyRun>& runs_;
    const StudyProcesses& processes_;
    std::string scene_;  // content of the scene file
    std::vector<StudyOutcome> outcomes_;
    std::vector<Process> running_;
    std::string missing_;  // path of a result that the summary of a run does not have
    std::size_t finished_ = 0;
    std::size_t failed_ = 0;
};

}  // namespace

std::filesystem::path folder_of(const StudyProcesses& processes, const StudyRun& run) {
    return processes.folder / fmt::format("run_{:04}", run.number);
}

std::vector<StudyOutcome> run_study(const StudyPlan& plan, const std::vector<StudyRun>& runs,
                                    const StudyProcesses& processes,
                                    const std::function<bool(const StudyProgress&)>& should_stop) {
    return StudyRunner(plan, runs, processes).run(should_stop);
}

}  // namespace ricochet
