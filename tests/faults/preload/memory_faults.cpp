// Makes allocations of a program fail. Preloaded with LD_PRELOAD.
//
// - RICOCHET_FAULT_ALLOCATION: number of the failing call of operator new, from 1, counted over all threads; it throws
//   std::bad_alloc, or returns null if it is the non-throwing form
// - RICOCHET_FAULT_ON: 1: all later calls fail too
// - RICOCHET_FAULT_ALLOCATIONS: a file that receives the number of calls at the end
//
// The count begins at main(), because the program cannot handle failures in the initialisation of libraries.
#include <dlfcn.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

struct Settings {
    std::int64_t at = 0;
    bool goes_on = false;
};

// The settings are not read in a constructor of this library, because other constructors may allocate before it runs.
const Settings& settings() noexcept {
    static const Settings read = [] {
        const char* at = std::getenv("RICOCHET_FAULT_ALLOCATION");
        const char* on = std::getenv("RICOCHET_FAULT_ON");
        return Settings{at == nullptr ? 0 : std::strtoll(at, nullptr, 10), on != nullptr && *on == '1'};
    }();
    return read;
}

using Main = int (*)(int, char**, char**);
Main main_of_program = nullptr;
std::atomic<bool> is_in_main{false};
std::atomic<std::int64_t> calls{0};

// Embree 3.13 can leave a thread's allocator bound to a destroyed one if memory runs out while it records the binding.
// The next hierarchy is then corrupted. Callers cannot repair that.
bool is_of_embree(const void* code) noexcept {
    Dl_info info{};
    return ::dladdr(code, &info) != 0 && info.dli_fname != nullptr &&
           std::strstr(info.dli_fname, "libembree") != nullptr;
}

bool is_to_fail(const void* caller) noexcept {
    if (!is_in_main) return false;
    const std::int64_t call = ++calls;
    const std::int64_t first = settings().at;
    return first > 0 && (call == first || (call > first && settings().goes_on)) && !is_of_embree(caller);
}

void* allocate(std::size_t size, const void* caller) noexcept {
    return is_to_fail(caller) ? nullptr : std::malloc(size == 0 ? 1 : size);
}

void* allocate(std::size_t size, std::align_val_t alignment, const void* caller) noexcept {
    if (is_to_fail(caller)) return nullptr;
    void* memory = nullptr;
    return posix_memalign(&memory, static_cast<std::size_t>(alignment), size == 0 ? 1 : size) == 0 ? memory : nullptr;
}

int call_main(int argc, char** argv, char** environment) {
    is_in_main = true;
    const int result = main_of_program(argc, argv, environment);
    is_in_main = false;
    return result;
}

// Works like the standard library: calls the new handler first.
void* required(void* memory) {
    if (memory != nullptr) return memory;
    if (const std::new_handler handler = std::get_new_handler()) handler();
    throw std::bad_alloc();
}

[[gnu::destructor]] void end() {
    const char* name = std::getenv("RICOCHET_FAULT_ALLOCATIONS");
    if (name == nullptr) return;
    std::FILE* file = std::fopen(name, "w");
    if (file == nullptr) return;
    (void)std::fprintf(file, "%lld\n", static_cast<long long>(calls));
    (void)std::fclose(file);
}

}  // namespace

// Start function of the C library, with another main().
extern "C" int __libc_start_main(Main main, int argc, char** argv, void (*begin)(), void (*end)(), void (*end_linker)(),
                                 void* stack_end) {
    main_of_program = main;
    const auto start = reinterpret_cast<decltype(&__libc_start_main)>(::dlsym(RTLD_NEXT, "__libc_start_main"));
    return start(call_main, argc, argv, begin, end, end_linker, stack_end);
}

void* operator new(std::size_t size) { return required(allocate(size, __builtin_return_address(0))); }
void* operator new[](std::size_t size) { return required(allocate(size, __builtin_return_address(0))); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    return required(allocate(size, alignment, __builtin_return_address(0)));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
    return required(allocate(size, alignment, __builtin_return_address(0)));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, __builtin_return_address(0));
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, __builtin_return_address(0));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
