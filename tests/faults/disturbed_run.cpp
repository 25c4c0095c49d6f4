#include "faults/disturbed_run.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "run/run_folder.h"
#include "support/counts.h"

namespace ricochet::test {
namespace {

constexpr const char* kScene = R"({
  "ricochet": 1,
  "simulation": {"time_step": 0.004, "duration": 0.4, "seed": 5},
  "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
  "materials": {"plain": {"restitution": 0.4, "friction": 0.3, "diffuse": 0.1}},
  "colliders": [{"name": "roof", "type": "mesh", "file": "roof.off", "material": "plain"},
                {"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "material": "plain"}],
  "emitters": [{"type": "box", "center": [0, 0, 0.3], "size": [1, 1, 0.4], "burst": 30, "rate": 300,
                "lifetime": [0.2, 0.1]}],
  "output": {"every": 10, "contacts": true, "checkpoint_every": 20}
})";
constexpr std::uint64_t kFirstCheckpoint = 20;
constexpr const char* kMesh = "OFF\n4 2 0\n-1 -1 0.2\n1 -1 0.1\n1 1 0.2\n-1 1 0.1\n3 0 1 2\n3 0 2 3\n";

std::string preload() {
    const char* others = std::getenv("LD_PRELOAD");  // NOLINT(concurrency-mt-unsafe): no code sets it
    return std::string("LD_PRELOAD=") + RICOCHET_FAULT_LIBRARY + (others == nullptr ? "" : ":" + std::string(others));
}

// Returns the environment that preloads the library. It includes sanitizer settings that a preloaded library and
// forbidden calls need.
std::vector<std::string> preloaded(std::vector<std::string> settings) {
    settings.push_back(preload());
    if (kSanitized) settings.emplace_back("ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0");
    return settings;
}

bool is_unfinished(const std::string& name) { return name.ends_with(".partial"); }

// Returns the files of a folder with their bytes.
std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
        if (!entry.is_regular_file()) continue;
        std::ifstream in(entry.path(), std::ios::binary);
        files[entry.path().filename().string()] = {std::istreambuf_iterator<char>(in),
                                                   std::istreambuf_iterator<char>()};
    }
    return files;
}

bool is_whole(const std::string& name, const std::string& bytes) {
    if (name.ends_with(".json")) return !nlohmann::json::parse(bytes, nullptr, false).is_discarded();
    if (name == kCheckpointFile || name == kExtensionFile || name == kRunMarkerFile)
        return true;  // checked by resuming and by running again
    return bytes.ends_with("</VTKFile>\n");
}

}  // namespace

std::vector<std::string> call_fault(const std::filesystem::path& path, const std::string& call, std::int64_t at,
                                    const std::string& action, bool goes_on) {
    return preloaded({"RICOCHET_FAULT_PATH=" + path.string(), "RICOCHET_FAULT_CALL=" + call,
                      "RICOCHET_FAULT_AT=" + std::to_string(at), "RICOCHET_FAULT_ACTION=" + action,
                      std::string("RICOCHET_FAULT_ON=") + (goes_on ? "1" : "0")});
}

std::vector<std::string> full_disk(const std::filesystem::path& path, std::int64_t bytes) {
    return preloaded({"RICOCHET_FAULT_PATH=" + path.string(), "RICOCHET_FAULT_BYTES=" + std::to_string(bytes)});
}

std::vector<std::string> no_memory(std::int64_t at, bool goes_on) {
    return preloaded(
        {"RICOCHET_FAULT_ALLOCATION=" + std::to_string(at), std::string("RICOCHET_FAULT_ON=") + (goes_on ? "1" : "0")});
}

std::int64_t count_allocations(const std::vector<std::string>& arguments) {
    const TemporaryFolder folder;
    ProgramStart start;
    start.environment = preloaded({"RICOCHET_FAULT_ALLOCATIONS=" + folder.path("count").string()});
    const ProgramResult result = run_ricochet(arguments, start);
    if (result.exit_code != 0) throw std::runtime_error("the undisturbed program failed: " + result.errors);
    return std::stoll(folder.read("count"));
}

std::vector<std::string> jumping_clocks(std::uint64_t seed) {
    return preloaded({"RICOCHET_FAULT_CLOCK=" + std::to_string(seed)});
}

bool can_disturb_calls() {
    ProgramStart start;
    start.environment = call_fault("/no such file", "open", 0, "5");
    return run_ricochet({"--version"}, start).exit_code == 0;
}

CallCounts count_calls(const std::filesystem::path& path, const std::vector<std::string>& arguments,
                       const ProgramStart& start) {
    const TemporaryFolder folder;
    ProgramStart counted = start;
    counted.environment =
        preloaded({"RICOCHET_FAULT_PATH=" + path.string(), "RICOCHET_FAULT_COUNTS=" + folder.path("counts").string()});
    counted.environment.insert(counted.environment.end(), start.environment.begin(), start.environment.end());
    const ProgramResult result = run_ricochet(arguments, counted);
    if (result.exit_code != 0) throw std::runtime_error("the undisturbed program failed: " + result.errors);
    std::istringstream lines(folder.read("counts"));
    CallCounts counts;
    std::string name;
    std::int64_t count = 0;
    while (lines >> name >> count) counts[name] = count;
    return counts;
}

void expect_clear_end(const ProgramResult& result) {
    EXPECT_EQ(result.signal, 0);
    if (result.exit_code == 0) {
        EXPECT_EQ(result.errors, "");
        return;
    }
    EXPECT_TRUE(result.exit_code == 1 || result.exit_code == 2) << result.exit_code;
    EXPECT_TRUE(result.errors.starts_with("ricochet: ")) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_EQ(result.errors.find("Success"), std::string::npos) << result.errors;
}

DisturbedRun::DisturbedRun() {
    std::filesystem::create_directories(input());
    (void)folder_.write("in/scene.json", kScene);
    (void)folder_.write("in/roof.off", kMesh);
    const ProgramResult result = run_ricochet(arguments());
    if (result.exit_code != 0) throw std::runtime_error("the undisturbed run failed: " + result.errors);
    files_ = files_in(output());
    files_.erase(kSummaryFile);
    files_.erase(kExtensionFile);
    files_["state"] = folder_.read("out.csv");
    state_hash_ = state_hash();
    clear();
}

void DisturbedRun::clear() const {
    std::filesystem::remove_all(output());
    std::filesystem::remove(folder_.path("out.csv"));
}

std::vector<std::string> DisturbedRun::arguments(bool resumed) const {
    std::vector<std::string> all{"run",
                                 folder_.path("in/scene.json").string(),
                                 "--output",
                                 output().string(),
                                 "--quiet",
                                 "--output-state",
                                 folder_.path("out.csv").string()};
    if (resumed) all.emplace_back("--resume");
    return all;
}

bool DisturbedRun::has_checkpoint() const { return std::filesystem::exists(output() / kCheckpointFile); }

std::string DisturbedRun::state_hash() const {
    const auto summary = nlohmann::json::parse(folder_.read("out/summary.json"), nullptr, false);
    return summary.is_discarded() ? "" : summary.value("state_hash", "");
}

void DisturbedRun::expect_nothing_half_written() const {
    for (const auto& [name, bytes] : files_in(output())) {
        if (is_unfinished(name)) continue;
        EXPECT_TRUE(is_whole(name, bytes)) << name << " is half-written";
        if (!step_of_frame_file(name) && !step_of_contact_file(name)) continue;
        const auto undisturbed = files_.find(name);
        ASSERT_NE(undisturbed, files_.end()) << name;
        EXPECT_TRUE(bytes == undisturbed->second) << name << " has other bytes";
    }
    const bool has_state = std::filesystem::exists(folder_.path("out.csv"));
    EXPECT_EQ(folder_.read("out.csv"), has_state ? files_.at("state") : "");
}

void DisturbedRun::expect_nothing_unfinished() const {
    for (const auto& [name, bytes] : files_in(output().parent_path())) EXPECT_FALSE(is_unfinished(name)) << name;
    for (const auto& [name, bytes] : files_in(output())) EXPECT_FALSE(is_unfinished(name)) << name;
}

void DisturbedRun::expect_complete() const {
    std::map<std::string, std::string> found = files_in(output());
    found.erase(kSummaryFile);
    found.erase(kExtensionFile);
    found["state"] = folder_.read("out.csv");
    for (const auto& [name, bytes] : files_) {
        EXPECT_EQ(found.count(name), 1U) << name << " is missing";
        EXPECT_TRUE(found[name] == bytes) << name << " has other bytes";
    }
    for (const auto& [name, bytes] : found) EXPECT_EQ(files_.count(name), 1U) << name << " is too much";
    EXPECT_EQ(state_hash(), state_hash_);
}

void DisturbedRun::expect_resumable() const {
    const bool is_beyond_checkpoint = std::filesystem::exists(output() / frame_file_name(kFirstCheckpoint + 10));
    const bool is_finished = std::filesystem::exists(output() / kSummaryFile);
    EXPECT_TRUE(has_checkpoint() || is_finished || !is_beyond_checkpoint) << "the checkpoint is lost";
    const ProgramResult result = run_ricochet(arguments(has_checkpoint()));
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    expect_complete();
}

void DisturbedRun::expect_survived(const ProgramResult& result) const {
    expect_clear_end(result);
    expect_nothing_half_written();
    expect_nothing_unfinished();
    if (result.exit_code == 0) expect_complete();
    expect_resumable();
}

}  // namespace ricochet::test
