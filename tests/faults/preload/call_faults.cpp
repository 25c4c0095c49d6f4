// Makes system calls of a program fail. Preloaded with LD_PRELOAD, on x86-64 Linux.
//
// A filter of the kernel (seccomp) turns the calls below into the signal SIGSYS. It covers the program, the streams of
// the C library, and all other libraries. The handler of the signal makes the call or simulates the fault. The
// environment selects the fault:
//
// - RICOCHET_FAULT_PATH: counts only calls whose file has this text in its path; without it nothing is done
// - RICOCHET_FAULT_CALL: open, write, sync, rename, close, unlink, or any of them ("any")
// - RICOCHET_FAULT_AT: number of the faulty call, from 1
// - RICOCHET_FAULT_ACTION: a number: the call does nothing and returns this errno; short: half of the bytes are
//   written; kill: the process is killed before the call
// - RICOCHET_FAULT_ON: 1: all later calls are faulty too
// - RICOCHET_FAULT_BYTES: size of the disk in bytes; further bytes are cut off, then the call gives ENOSPC
// - RICOCHET_FAULT_COUNTS: a file that receives the number of calls at the end, one line "NAME COUNT" per kind, and the
//   number of bytes to be written
//
// Child programs die of SIGSYS, because they inherit the filter but not the handler.
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

// System call at its own address, which the filter lets pass. It works like syscall() of the C library but returns
// -errno.
extern "C" long ricochet_fault_syscall(long number, long a, long b, long c, long d, long e, long f);
extern "C" const char ricochet_fault_syscall_end[];
asm(R"(
.text
.hidden ricochet_fault_syscall
.hidden ricochet_fault_syscall_end
.globl ricochet_fault_syscall
.globl ricochet_fault_syscall_end
.type ricochet_fault_syscall, @function
ricochet_fault_syscall:
    movq %rdi, %rax
    movq %rsi, %rdi
    movq %rdx, %rsi
    movq %rcx, %rdx
    movq %r8, %r10
    movq %r9, %r8
    movq 8(%rsp), %r9
    syscall
ricochet_fault_syscall_end:
    ret
)");

namespace {

enum Kind : std::size_t { kOpen, kWrite, kSync, kRename, kClose, kUnlink, kKinds };
constexpr std::array<const char*, kKinds> kNames{"open", "write", "sync", "rename", "close", "unlink"};

struct TrappedCall {
    int number;
    Kind kind;
};
constexpr std::array kTrapped{
    TrappedCall{SYS_open, kOpen},        TrappedCall{SYS_openat, kOpen},    TrappedCall{SYS_write, kWrite},
    TrappedCall{SYS_writev, kWrite},     TrappedCall{SYS_pwrite64, kWrite}, TrappedCall{SYS_fsync, kSync},
    TrappedCall{SYS_fdatasync, kSync},   TrappedCall{SYS_rename, kRename},  TrappedCall{SYS_renameat, kRename},
    TrappedCall{SYS_renameat2, kRename}, TrappedCall{SYS_close, kClose},    TrappedCall{SYS_unlink, kUnlink},
    TrappedCall{SYS_unlinkat, kUnlink}};

// Settings, read once before the filter is installed.
const char* path_part = nullptr;
const char* counts_file = nullptr;
std::array<bool, kKinds> is_chosen{};
std::int64_t fault_at = 0;
int fault_errno = 0;
bool is_short = false;
bool is_kill = false;
bool goes_on = false;
bool is_limited = false;

std::atomic<std::int64_t> bytes_left{0};
std::atomic<std::int64_t> chosen_calls{0};
std::array<std::atomic<std::int64_t>, kKinds> counts{};
std::atomic<std::int64_t> bytes_written{0};

struct Call {
    long number;
    std::array<long, 6> a;

    [[nodiscard]] long make() const { return ricochet_fault_syscall(number, a[0], a[1], a[2], a[3], a[4], a[5]); }
};

long make(long number, long a, long b = 0, long c = 0) { return Call{number, {a, b, c, 0, 0, 0}}.make(); }

const char* text_at(long address) {
    return reinterpret_cast<const char*>(address);
}  // NOLINT(performance-no-int-to-ptr)

// Writes "/proc/self/fd/N" without the C library, which a signal handler must not call.
void name_descriptor(std::array<char, 40>& name, long descriptor) {
    constexpr const char* kFolder = "/proc/self/fd/";
    std::size_t end = std::strlen(kFolder);
    std::memcpy(name.data(), kFolder, end);
    std::array<char, 20> digits{};
    std::size_t count = 0;
    do {
        digits[count++] = static_cast<char>('0' + descriptor % 10);
        descriptor /= 10;
    } while (descriptor > 0);
    while (count > 0) name[end++] = digits[--count];
    name[end] = '\0';
}

bool is_watched_path(const char* path) { return path != nullptr && std::strstr(path, path_part) != nullptr; }

bool is_watched_descriptor(long descriptor) {
    if (descriptor < 0) return false;
    std::array<char, 40> link{};
    name_descriptor(link, descriptor);
    std::array<char, 4096> path{};
    const long length = make(SYS_readlink, reinterpret_cast<long>(link.data()), reinterpret_cast<long>(path.data()),
                             static_cast<long>(path.size() - 1));
    return length > 0 && is_watched_path(path.data());
}

bool is_watched(const Call& call) {
    switch (call.number) {
        case SYS_open:
        case SYS_unlink:
            return is_watched_path(text_at(call.a[0]));
        case SYS_openat:
        case SYS_unlinkat:
        case SYS_rename:
            return is_watched_path(text_at(call.a[1]));
        case SYS_renameat:
        case SYS_renameat2:
            return is_watched_path(text_at(call.a[3]));
        default:
            return is_watched_descriptor(call.a[0]);
    }
}

std::size_t bytes_of(const Call& call) {
    if (call.number != SYS_writev) return static_cast<std::size_t>(call.a[2]);
    std::size_t sum = 0;
    const auto* parts = reinterpret_cast<const iovec*>(call.a[1]);  // NOLINT(performance-no-int-to-ptr)
    for (long i = 0; i < call.a[2]; ++i) sum += parts[i].iov_len;
    return sum;
}

// Writes the first bytes of the data of a call.
long write_part(const Call& call, std::size_t bytes) {
    if (call.number != SYS_writev) {
        Call part = call;
        part.a[2] = static_cast<long>(bytes);
        return part.make();
    }
    std::size_t done = 0;
    const auto* parts = reinterpret_cast<const iovec*>(call.a[1]);  // NOLINT(performance-no-int-to-ptr)
    for (long i = 0; i < call.a[2] && done < bytes; ++i) {
        const std::size_t now = parts[i].iov_len < bytes - done ? parts[i].iov_len : bytes - done;
        const long written =
            make(SYS_write, call.a[0], reinterpret_cast<long>(parts[i].iov_base), static_cast<long>(now));
        if (written < 0) return done == 0 ? written : static_cast<long>(done);
        done += static_cast<std::size_t>(written);
    }
    return static_cast<long>(done);
}

long write_to_limited_disk(const Call& call) {
    const auto wanted = static_cast<std::int64_t>(bytes_of(call));
    const std::int64_t left = bytes_left.fetch_sub(wanted);
    if (left >= wanted) return call.make();
    if (left <= 0) return -ENOSPC;
    return write_part(call, static_cast<std::size_t>(left));
}

long fail(const Call& call, Kind kind) {
    if (is_kill) (void)make(SYS_kill, make(SYS_getpid, 0), SIGKILL);
    if (is_short) return kind == kWrite ? write_part(call, (bytes_of(call) + 1) / 2) : call.make();
    if (kind == kClose) (void)call.make();  // the descriptor is released, whatever close() returns
    return -fault_errno;
}

long answer(const Call& call, Kind kind) {
    if (!is_watched(call)) return call.make();
    ++counts[kind];
    if (kind == kWrite) bytes_written += static_cast<std::int64_t>(bytes_of(call));
    if (is_limited && kind == kWrite) return write_to_limited_disk(call);
    if (!is_chosen[kind]) return call.make();
    const std::int64_t number = ++chosen_calls;
    return number == fault_at || (goes_on && number > fault_at) ? fail(call, kind) : call.make();
}

void handle(int, siginfo_t* info, void* context) {
    auto& registers = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
    const Call call{info->si_syscall,
                    {static_cast<long>(registers[REG_RDI]), static_cast<long>(registers[REG_RSI]),
                     static_cast<long>(registers[REG_RDX]), static_cast<long>(registers[REG_R10]),
                     static_cast<long>(registers[REG_R8]), static_cast<long>(registers[REG_R9])}};
    for (const TrappedCall& trapped : kTrapped) {
        if (trapped.number == call.number) registers[REG_RAX] = answer(call, trapped.kind);
    }
}

sock_filter statement(unsigned code, unsigned value, unsigned char then = 0, unsigned char otherwise = 0) {
    return {static_cast<std::uint16_t>(code), then, otherwise, value};
}

// Installs the filter. It lets pass all other system calls, and calls made by the handler.
bool install_filter() {
    constexpr std::size_t kEnd = kTrapped.size() + 8;
    std::array<sock_filter, kEnd> filter{};
    std::size_t at = 0;
    filter[at++] = statement(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr));
    for (std::size_t i = 0; i < kTrapped.size(); ++i) {
        filter[at++] = statement(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(kTrapped[i].number),
                                 static_cast<unsigned char>(kTrapped.size() - i));
    }
    filter[at++] = statement(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    const auto address = reinterpret_cast<std::uintptr_t>(&ricochet_fault_syscall_end);
    constexpr unsigned kAddress = offsetof(seccomp_data, instruction_pointer);
    filter[at++] = statement(BPF_LD | BPF_W | BPF_ABS, kAddress);
    filter[at++] = statement(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(address), 0, 2);
    filter[at++] = statement(BPF_LD | BPF_W | BPF_ABS, kAddress + 4);
    filter[at++] = statement(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(address >> 32U), 1, 0);
    filter[at++] = statement(BPF_RET | BPF_K, SECCOMP_RET_TRAP);
    filter[at++] = statement(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    sock_fprog program{};
    program.len = static_cast<std::uint16_t>(at);
    program.filter = filter.data();
    return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

std::int64_t number_of(const char* name, std::int64_t otherwise) {
    const char* text = std::getenv(name);
    return text == nullptr ? otherwise : std::strtoll(text, nullptr, 10);
}

void read_settings() {
    path_part = std::getenv("RICOCHET_FAULT_PATH");
    counts_file = std::getenv("RICOCHET_FAULT_COUNTS");
    const char* call = std::getenv("RICOCHET_FAULT_CALL");
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
        is_chosen[kind] = call != nullptr && (std::strcmp(call, kNames[kind]) == 0 || std::strcmp(call, "any") == 0);
    }
    fault_at = number_of("RICOCHET_FAULT_AT", 0);
    goes_on = number_of("RICOCHET_FAULT_ON", 0) != 0;
    fault_errno = static_cast<int>(number_of("RICOCHET_FAULT_ACTION", 0));
    const char* action = std::getenv("RICOCHET_FAULT_ACTION");
    is_short = action != nullptr && std::strcmp(action, "short") == 0;
    is_kill = action != nullptr && std::strcmp(action, "kill") == 0;
    bytes_left = number_of("RICOCHET_FAULT_BYTES", -1);
    is_limited = bytes_left.load() >= 0;
}

[[gnu::constructor]] void begin() {
    read_settings();
    if (path_part == nullptr) return;
    struct sigaction action {};
    action.sa_sigaction = handle;
    action.sa_flags = SA_SIGINFO | SA_NODEFER;
    if (::sigaction(SIGSYS, &action, nullptr) == 0 && install_filter()) return;
    constexpr char kRefused[] = "the kernel takes no filter of system calls\n";
    (void)!::write(STDERR_FILENO, kRefused, sizeof(kRefused) - 1);
    ::_exit(77);
}

struct Report {
    std::array<char, 400> text{};
    std::size_t length = 0;

    void add(const char* name, std::int64_t count) {
        while (*name != '\0') text[length++] = *name++;
        text[length++] = ' ';
        std::array<char, 20> digits{};
        std::size_t found = 0;
        do {
            digits[found++] = static_cast<char>('0' + count % 10);
            count /= 10;
        } while (count > 0);
        while (found > 0) text[length++] = digits[--found];
        text[length++] = '\n';
    }
};

// Uses the system calls of the handler, because the file may be a watched one.
[[gnu::destructor]] void end() {
    if (path_part == nullptr || counts_file == nullptr) return;
    Report report;
    for (std::size_t kind = 0; kind < kKinds; ++kind) report.add(kNames[kind], counts[kind]);
    report.add("bytes", bytes_written);
    const long file = make(SYS_open, reinterpret_cast<long>(counts_file), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    (void)make(SYS_write, file, reinterpret_cast<long>(report.text.data()), static_cast<long>(report.length));
    (void)make(SYS_close, file);
}

}  // namespace
