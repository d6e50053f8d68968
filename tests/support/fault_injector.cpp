// Preloaded into the program, makes it meet a fault at an exact step, the same in every run:
//   ECHOCINE_FAULT=KIND:N
// Steps of files are calls that change them, counted from 1. At step N, before the call,
//   kill  the program ends as by kill -9; half  as well, after half of the bytes where it is a
//   write full  this and all later calls that need space fail with ENOSPC int, term, hup  the
//   signal arrives hang  the call does not come back, as on a disk that is gone
// Steps of memory are allocations made within main():
//   memory   allocation N fails; shortage  all of 4 KiB or more from N on fail
// ECHOCINE_FAULT_STEPS=FILE takes the number of both kinds of steps when the program ends, and of
// files renamed before what was written to them was synced.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
}

namespace {

std::atomic<long> file_steps{0}, memory_steps{0}, unsynced_renames{0};

// Files by inode that were written and not synced since. A fixed table: allocations are steps.
constexpr size_t kMostFiles = 4096;
ino_t unsynced[kMostFiles];
size_t unsynced_count = 0;
std::atomic_flag unsynced_lock = ATOMIC_FLAG_INIT;

template <typename Body>
void withUnsynced(const Body& body) {
  while (unsynced_lock.test_and_set(std::memory_order_acquire)) {
  }
  body();
  unsynced_lock.clear(std::memory_order_release);
}

ino_t* unsyncedPlace(ino_t inode) {
  ino_t* const end = unsynced + unsynced_count;
  for (ino_t* at = unsynced; at != end; ++at)
    if (*at == inode) return at;
  return nullptr;
}

void markWritten(int file) {
  struct stat status {};
  if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return;
  withUnsynced([&] {
    if (unsyncedPlace(status.st_ino) != nullptr) return;
    if (unsynced_count == kMostFiles) std::abort();
    unsynced[unsynced_count++] = status.st_ino;
  });
}

void markSynced(int file) {
  struct stat status {};
  if (::fstat(file, &status) != 0) return;
  withUnsynced([&] {
    if (ino_t* const at = unsyncedPlace(status.st_ino)) *at = unsynced[--unsynced_count];
  });
}

bool isUnsynced(const char* path) {
  struct stat status {};
  bool found = false;
  if (::lstat(path, &status) == 0)
    withUnsynced([&] {
      found = S_ISDIR(status.st_mode) ? unsynced_count > 0  // it holds all files of the run
                                      : unsyncedPlace(status.st_ino) != nullptr;
    });
  return found;
}
std::atomic<bool> in_main{false};
char kind[16] = "";
long step = 0;

template <typename Function>
Function next(Function, const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}
#define REAL(function) next(&::function, #function)

bool is(const char* name) {
  return std::strcmp(kind, name) == 0;
}

[[noreturn]] void die() {
  ::kill(::getpid(), SIGKILL);
  for (;;) ::pause();
}

// Takes a step of files; true when the call has to fail for want of space.
bool full(bool needs_space) {
  if (!in_main) return false;
  const long now = ++file_steps;
  if (now == step && (is("kill") || is("half"))) die();
  if (now == step && is("int")) ::kill(::getpid(), SIGINT);
  if (now == step && is("term")) ::kill(::getpid(), SIGTERM);
  if (now == step && is("hup")) ::kill(::getpid(), SIGHUP);
  if (now == step && is("hang"))
    for (;;) ::pause();
  if (!needs_space || step == 0 || now < step || !is("full")) return false;
  errno = ENOSPC;
  return true;
}

bool outOfMemory(size_t size) {
  if (!in_main) return false;
  const long now = ++memory_steps;
  const bool fails =
      (now == step && is("memory")) || (step > 0 && now >= step && size >= 4096 && is("shortage"));
  if (fails) errno = ENOMEM;
  return fails;
}

int (*real_main)(int, char**, char**) = nullptr;

int watchedMain(int argc, char** argv, char** environment) {
  if (const char* fault = std::getenv("ECHOCINE_FAULT")) {
    const char* colon = std::strchr(fault, ':');
    const auto length = static_cast<size_t>(colon - fault);
    std::memcpy(kind, fault, length < sizeof kind ? length : sizeof kind - 1);
    step = std::atol(colon + 1);
  }
  in_main = true;
  const int code = real_main(argc, argv, environment);
  in_main = false;
  if (const char* file = std::getenv("ECHOCINE_FAULT_STEPS"))
    if (std::FILE* out = std::fopen(file, "w")) {
      std::fprintf(out, "%ld %ld %ld\n", file_steps.load(), memory_steps.load(),
                   unsynced_renames.load());
      std::fclose(out);
    }
  return code;
}

}  // namespace

extern "C" {

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(),
                      void (*fini)(), void (*unload)(), void* stack_end) {
  using Start =
      int (*)(int (*)(int, char**, char**), int, char**, void (*)(), void (*)(), void (*)(), void*);
  real_main = main;
  const auto start = reinterpret_cast<Start>(::dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(watchedMain, argc, argv, init, fini, unload, stack_end);
}

int open(const char* path, int flags, ...) {
  mode_t mode = 0;
  if (flags & O_CREAT) {
    va_list rest;
    va_start(rest, flags);
    mode = va_arg(rest, mode_t);
    va_end(rest);
    if (full(true)) return -1;
  }
  static const auto real = REAL(open);
  return real(path, flags, mode);
}

ssize_t write(int file, const void* bytes, size_t size) {
  static const auto real = REAL(write);
  if (file <= STDERR_FILENO) return real(file, bytes, size);
  markWritten(file);
  if (in_main && is("half") && file_steps + 1 == step) (void)!real(file, bytes, size / 2);
  return full(true) ? -1 : real(file, bytes, size);
}

int fsync(int file) {
  static const auto real = REAL(fsync);
  markSynced(file);
  return real(file);
}

int syncfs(int file) noexcept {
  static const auto real = REAL(syncfs);
  withUnsynced([] { unsynced_count = 0; });
  return real(file);
}

int rename(const char* from, const char* to) noexcept {
  static const auto real = REAL(rename);
  if (in_main && isUnsynced(from)) ++unsynced_renames;
  return full(false) ? -1 : real(from, to);
}

int remove(const char* path) noexcept {
  static const auto real = REAL(remove);
  return full(false) ? -1 : real(path);
}

int unlink(const char* path) noexcept {
  static const auto real = REAL(unlink);
  return full(false) ? -1 : real(path);
}

int unlinkat(int folder, const char* path, int flags) noexcept {
  static const auto real = REAL(unlinkat);
  return full(false) ? -1 : real(folder, path, flags);
}

int mkdir(const char* path, mode_t mode) noexcept {
  static const auto real = REAL(mkdir);
  return full(true) ? -1 : real(path, mode);
}

#ifndef ECHOCINE_FAULTS_OF_FILES_ONLY  // a sanitizer has an allocator of its own

void* malloc(size_t size) noexcept {
  return outOfMemory(size) ? nullptr : __libc_malloc(size);
}

void* calloc(size_t count, size_t size) noexcept {
  return outOfMemory(count * size) ? nullptr : __libc_calloc(count, size);
}

void* realloc(void* old, size_t size) noexcept {
  return outOfMemory(size) ? nullptr : __libc_realloc(old, size);
}

void* memalign(size_t alignment, size_t size) noexcept {
  return outOfMemory(size) ? nullptr : __libc_memalign(alignment, size);
}

void* aligned_alloc(size_t alignment, size_t size) noexcept {
  return memalign(alignment, size);
}

int posix_memalign(void** out, size_t alignment, size_t size) noexcept {
  void* const memory = memalign(alignment, size);
  if (memory == nullptr) return ENOMEM;
  *out = memory;
  return 0;
}

#endif

}  // extern "C"
