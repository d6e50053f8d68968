#pragma once
// One connection of the server, and the way of responses from jobs to the polling thread.

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "live/http_response.h"

namespace echocine::live {

// A file descriptor that is closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int number() const { return number_; }

 private:
  int number_;
};

struct Connection {
  Descriptor socket;
  std::uint64_t id = 0;
  std::string in{}, out{};
  std::size_t sent = 0;
  bool waits = false;   // for its job
  bool closes = false;  // after its last byte
  bool drains = false;  // all is sent; what the client still sends is dropped
  bool lost = false;
  std::chrono::steady_clock::time_point since =
      std::chrono::steady_clock::now();  // of the last request's end, or the next one's start
};

// Responses of jobs on their way to the polling thread. Jobs may outlive the server.
struct Mailbox {
  struct Mail {
    std::uint64_t connection;
    HttpResponse response;
  };
  Mailbox();
  void put(std::uint64_t connection, HttpResponse response);  // thread-safe
  std::vector<Mail> take();                                   // all so far

  Descriptor wake;
  std::mutex mutex;
  std::vector<Mail> mails;
};

// Queues the response's bytes.
void respond(Connection& connection, const HttpResponse& response, bool keep_alive);
// Reads and writes what the socket takes now; a broken connection becomes lost.
void receive(Connection& connection);
void transmit(Connection& connection);

}  // namespace echocine::live
