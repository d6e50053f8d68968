#include "cli/standard_error.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <exception>
#include <new>

#include "core/out_of_memory.h"

namespace echocine {

namespace {

// A plain number: handlers read it when nothing else may be relied on.
int exit_code = 1;

// Only what is allowed in a signal handler: write() and _exit(), no formatting.
void endAborted(int) {
  endsFirst();
  writeError("echocine: a library aborted, probably out of memory\n");
  ::_exit(exit_code);
}

// An exception that left a thread of a library, or was thrown while another was on its way.
[[noreturn]] void endUncaught() {
  constexpr const char* kUnknown = "a library aborted, probably out of memory";
  endsFirst();
  writeError("echocine: ");
  try {
    if (const std::exception_ptr uncaught = std::current_exception())
      std::rethrow_exception(uncaught);
    writeError(kUnknown);
  } catch (const std::bad_alloc&) {
    writeError(kOutOfMemory);
  } catch (const std::exception& error) {
    writeError(error.what());
  } catch (...) {
    writeError(kUnknown);
  }
  writeError("\n");
  ::_exit(exit_code);
}

}  // namespace

// A closed stream's number would go to the next file that is opened, and messages into that file.
void keepStandardStreams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
      (void)::open("/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY);
}

void writeError(std::string_view text) noexcept {
  while (!text.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void endsFirst() noexcept {
  static std::atomic<pid_t> first{0};
  pid_t present = 0;
  if (first.compare_exchange_strong(present, ::gettid()) || present == ::gettid()) return;
  // Another thread is ending the program: this one must print no line and wait for the end.
  for (;;) ::pause();
}

void endCrashesInOneLine(int code) {
  exit_code = code;
  std::set_terminate(endUncaught);
  std::signal(SIGABRT, endAborted);
}

}  // namespace echocine
