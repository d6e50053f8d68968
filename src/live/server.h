#pragma once
// The socket part: one thread that polls all connections of 127.0.0.1.

#include <functional>
#include <memory>
#include <variant>

#include "live/http_request.h"
#include "live/job_queue.h"

namespace echocine::live {

// Bounds of connections. Our choice: a browser opens up to 6 for each page.
inline constexpr std::size_t kMostConnections = 64;
inline constexpr int kRequestSeconds = 10;  // from the first byte of a request to its last
inline constexpr int kIdleSeconds = 120;    // between two requests

class Server {
 public:
  // A response at once, or a job for the queue.
  using Reply = std::variant<HttpResponse, LiveJob>;
  using Handler = std::function<Reply(const HttpRequest&)>;

  // Listens on 127.0.0.1; port 0: any free one. Throws JobError in one line, also if the port is
  // taken.
  explicit Server(int port);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const;

  // Serves until `stop` is true; it is polled every 50 ms. Refused and broken requests close their
  // connection only. A connection beyond the bound is closed at once.
  void run(const Handler& handler, JobQueues& queues, const std::function<bool()>& stop);

 private:
  struct Parts;
  const std::unique_ptr<Parts> parts_;
};

}  // namespace echocine::live
