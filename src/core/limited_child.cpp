#include "core/limited_child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <new>

#include "core/stop.h"

namespace echocine {

namespace {

// Exit codes of the child.
constexpr int kChildDone = 0, kChildFailed = 1, kNoMemory = 2;
// The last bytes of a complete answer. They tell where the exit code is lost: a host program may
// ignore or collect the ends of its children.
constexpr char kTrailer[] = "end of answer";

class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_, O_CLOEXEC) != 0)
      throw JobError(fmt::format("no pipe to a child process: {}", std::strerror(errno)));
  }
  ~Pipe() {
    closeEnd(0);
    closeEnd(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int end(int i) const { return ends_[i]; }
  void closeEnd(int i) {
    if (ends_[i] >= 0) ::close(ends_[i]);
    ends_[i] = -1;
  }

 private:
  int ends_[2] = {-1, -1};
};

void writePipe(int pipe, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t done = ::write(pipe, at, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) ::_exit(kChildFailed);  // the parent is gone or has enough
    at += done;
    size -= static_cast<std::size_t>(done);
  }
}

// Address space of this process; 0 where the system does not say.
std::size_t addressSpace() {
  unsigned long pages = 0;
  if (std::FILE* const file = std::fopen("/proc/self/statm", "re")) {
    if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void limitUse(__rlimit_resource_t what, rlim_t value) {
  rlimit now{};
  if (::getrlimit(what, &now) == 0 && now.rlim_max != RLIM_INFINITY)
    value = std::min(value, now.rlim_max);
  const rlimit wanted{value, now.rlim_max};
  ::setrlimit(what, &wanted);
}

// Signals of the parent's program mean nothing here; its standard streams stay clean.
void standApart(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kChildFailed);
  for (const int sign : {SIGINT, SIGTERM, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU})
    ::signal(sign, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {0, 1, 2}) ::dup2(nowhere, stream);
}

[[noreturn]] void liveAsChild(const ChildLimits& limits, std::size_t memory, pid_t parent, int pipe,
                              const std::function<void(const ChildWriter&)>& act) {
  standApart(parent);
  limitUse(RLIMIT_CORE, 0);
  limitUse(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(limits.cpu_s)));
  if (memory > 0) limitUse(RLIMIT_AS, memory + limits.memory_bytes);
  try {
    act([pipe](std::span<const std::byte> bytes) { writePipe(pipe, bytes.data(), bytes.size()); });
    writePipe(pipe, kTrailer, sizeof kTrailer);
  } catch (const std::bad_alloc&) {
    ::_exit(kNoMemory);
  } catch (...) {
    ::_exit(kChildFailed);
  }
  ::_exit(kChildDone);
}

// Ends and collects the child, whatever happens.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() {
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Its status, or -1 if someone else has collected it.
  int wait() {
    int status = 0;
    pid_t done = 0;
    do done = ::waitpid(id_, &status, 0);
    while (done < 0 && errno == EINTR);
    id_ = 0;
    return done < 0 ? -1 : status;
  }

 private:
  pid_t id_;
};

// False if the answer is longer than it may be.
bool readPipe(int pipe, std::size_t most, std::vector<std::byte>& bytes) {
  constexpr int kPoll_ms = 50;
  constexpr std::size_t kPiece = std::size_t{1} << 16;
  for (;;) {
    checkpoint();
    pollfd ready{pipe, POLLIN, 0};
    const int found = ::poll(&ready, 1, kPoll_ms);
    if (found == 0 || (found < 0 && errno == EINTR)) continue;
    const std::size_t size = bytes.size();
    bytes.resize(size + kPiece);
    const ssize_t got = ::read(pipe, bytes.data() + size, kPiece);
    bytes.resize(size + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return true;
    if (bytes.size() > most) return false;
  }
}

ChildEnd endOf(int status, bool complete) {
  if (complete) return ChildEnd::done;
  if (status == -1) return ChildEnd::crashed;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return ChildEnd::out_of_time;
  const bool killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;  // the system's memory
  if (killed || (WIFEXITED(status) && WEXITSTATUS(status) == kNoMemory))
    return ChildEnd::out_of_memory;
  return ChildEnd::crashed;
}

}  // namespace

ChildAnswer runInChild(const ChildLimits& limits,
                       const std::function<void(const ChildWriter&)>& act) {
  checkpoint();
  const std::size_t memory = addressSpace();
  const pid_t parent = ::getpid();
  Pipe pipe;
  const pid_t id = ::fork();
  if (id < 0)
    throw JobError(fmt::format("no child process to read a file: {}", std::strerror(errno)));
  if (id == 0) liveAsChild(limits, memory, parent, pipe.end(1), act);
  Child child(id);
  pipe.closeEnd(1);
  ChildAnswer answer;
  if (!readPipe(pipe.end(0), limits.answer_bytes + sizeof kTrailer, answer.bytes)) {
    answer.end = ChildEnd::too_long;
    return answer;
  }
  const int status = child.wait();
  const std::size_t size = answer.bytes.size();
  const bool complete =
      size >= sizeof kTrailer &&
      std::memcmp(answer.bytes.data() + size - sizeof kTrailer, kTrailer, sizeof kTrailer) == 0;
  if (complete) answer.bytes.resize(size - sizeof kTrailer);
  answer.end = endOf(status, complete);
  return answer;
}

}  // namespace echocine
