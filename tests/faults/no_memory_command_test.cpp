// Tests of memory that runs out at any allocation of a command, within one process. The command ends with one line and
// an exit code, and gives the same output when it is repeated.
// Commands that make or read JSON documents are excluded. The destructors of the JSON library allocate, and end the
// program if they fail. memory_faults_test.cpp runs those commands as separate programs.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "support/allocation_guard.h"
#include "support/counts.h"
#include "support/temporary_folder.h"

/// main() of the tool, which is compiled into this program under this name.
int ricochet_main(int argc, char** argv);

namespace ricochet {
namespace RICOCHET_FILE {

using test::AllocationFault;

constexpr const char* kScene = R"({
  "ricochet": 1,
  "simulation": {"time_step": 0.02, "duration": 0.2, "seed": 5},
  "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
  "materials": {"plain": {"restitution": 0.4, "friction": 0.3}},
  "colliders": [{"name": "roof", "type": "mesh", "file": "roof.off", "material": "plain"}],
  "emitters": [{"type": "box", "center": [0, 0, 0.5], "size": [1, 1, 0.4], "burst": 10, "rate": 100}],
  "output": {"every": 2, "contacts": true, "checkpoint_every": 4}
})";
constexpr const char* kMesh = "OFF\n4 2 0\n-1 -1 0.2\n1 -1 0.1\n1 1 0.2\n-1 1 0.1\n3 0 1 2\n3 0 2 3\n";

/// Redirects a standard stream into a file during its lifetime.
class Redirection {
public:
    Redirection(std::FILE* stream, const std::filesystem::path& file)
        : stream_(stream), kept_(::dup(::fileno(stream))) {
        (void)std::fflush(stream_);
        const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
        (void)::dup2(opened, ::fileno(stream_));
        ::close(opened);
    }
    ~Redirection() {
        (void)std::fflush(stream_);
        (void)::dup2(kept_, ::fileno(stream_));
        ::close(kept_);
    }
    Redirection(const Redirection&) = delete;
    Redirection& operator=(const Redirection&) = delete;

private:
    std::FILE* stream_;
    int kept_;
};

struct Ended {
    int exit_code = 0;
    std::uint64_t allocations = 0;
    std::string output;
    std::string errors;
};

class NoMemoryForCommand : public testing::Test {
protected:
    NoMemoryForCommand() {
        scene_ = folder_.write("scene.json", kScene).string();
        mesh_ = folder_.write("roof.off", kMesh).string();
    }

    /// allocation: number of the allocation that fails, or 0 for none.
    Ended call(std::vector<std::string> arguments, std::uint64_t allocation = 0) {
        arguments.insert(arguments.begin(), "ricochet");
        std::vector<char*> pointers;
        for (std::string& argument : arguments) pointers.push_back(argument.data());
        pointers.push_back(nullptr);
        Ended ended;
        {
            const Redirection output(stdout, folder_.path("output.txt"));
            const Redirection errors(stderr, folder_.path("errors.txt"));
            const AllocationFault fault(allocation);
            ended.exit_code = ricochet_main(static_cast<int>(arguments.size()), pointers.data());
            ended.allocations = fault.calls();
        }
        ended.output = folder_.read("output.txt");
        ended.errors = folder_.read("errors.txt");
        return ended;
    }

    /// Calls the command once for each failing allocation in a long run, or for a sample of them. check: receives the
    /// result of each call.
    void fail_anywhere(const std::vector<std::string>& arguments, const std::function<void(const Ended&)>& check) {
        ASSERT_EQ(call(arguments).exit_code, 0);
        const std::uint64_t allocations = call(arguments).allocations;
        const std::uint64_t wanted = test::is_long_run() ? 3000 : 40;
        int told = 0;
        for (std::uint64_t at = 1; at <= allocations; at += allocations / wanted + 1) {
            SCOPED_TRACE(testing::Message() << "allocation " << at << " of " << allocations);
            const Ended ended = call(arguments, at);
            if (ended.exit_code != 0) {
                ++told;
                EXPECT_EQ(ended.exit_code, 1) << ended.errors;
                EXPECT_TRUE(ended.errors.starts_with("ricochet: ")) << ended.errors;
                EXPECT_EQ(std::count(ended.errors.begin(), ended.errors.end(), '\n'), 1) << ended.errors;
                EXPECT_NE(ended.errors.find("memory"), std::string::npos) << ended.errors;
            }
            check(ended);
        }
        EXPECT_GT(told, 0);
    }

    test::TemporaryFolder folder_;
    std::string scene_;
    std::string mesh_;
};

TEST_F(NoMemoryForCommand, CheckAndInfoGiveTheirFullOutputOrFail) {
    const std::vector<std::vector<std::string>> commands{{"check", scene_}, {"info", mesh_}};
    for (const std::vector<std::string>& arguments : commands) {
        SCOPED_TRACE(arguments.front());
        const std::string whole = call(arguments).output;
        EXPECT_FALSE(whole.empty());
        fail_anywhere(arguments, [&](const Ended& ended) {
            EXPECT_TRUE(ended.exit_code != 0 || ended.output == whole) << ended.output;
            EXPECT_TRUE(call(arguments).output == whole);
        });
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
