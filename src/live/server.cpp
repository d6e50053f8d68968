#include "live/server.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <vector>

#include "core/error.h"
#include "live/connection.h"

namespace echocine::live {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kPoll_ms = 50;
constexpr int kDrainSeconds = 2;

[[noreturn]] void fail(const std::string& what, int error) {
  throw JobError(fmt::format("live: {}: {}", what, std::strerror(error)));
}

Descriptor listener(int port, int& bound) {
  Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (socket.number() < 0) fail("no socket", errno);
  const int yes = 1;
  ::setsockopt(socket.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  auto* plain = reinterpret_cast<sockaddr*>(&address);
  if (::bind(socket.number(), plain, sizeof address) != 0 || ::listen(socket.number(), 32) != 0)
    fail(fmt::format("port {} of 127.0.0.1", port), errno);
  socklen_t size = sizeof address;
  if (::getsockname(socket.number(), plain, &size) != 0) fail("no port", errno);
  bound = ntohs(address.sin_port);
  return socket;
}

}  // namespace

struct Server::Parts {
  explicit Parts(int wanted) : socket(listener(wanted, port)) {
    if (mailbox->wake.number() < 0) fail("no event", errno);
  }

  void accept();
  void handle(Connection& connection, const Handler& handler, JobQueues& queues);
  void deliver();
  void step(const Handler& handler, JobQueues& queues);
  void dropOverdue();
  std::vector<pollfd> wishes() const;

  int port = 0;
  Descriptor socket;
  std::vector<Connection> connections;
  std::uint64_t next_id = 1;
  std::shared_ptr<Mailbox> mailbox = std::make_shared<Mailbox>();
};

void Server::Parts::accept() {
  for (;;) {
    Descriptor taken(::accept4(socket.number(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (taken.number() < 0) return;
    if (connections.size() >= kMostConnections) continue;  // closed at once
    const int yes = 1;
    ::setsockopt(taken.number(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    connections.push_back({std::move(taken), next_id++});
  }
}

// Requests of one connection are answered one after the other.
void Server::Parts::handle(Connection& connection, const Handler& handler, JobQueues& queues) {
  while (!connection.waits && !connection.closes && !connection.in.empty()) {
    auto parsed = parseRequest(connection.in);
    if (std::holds_alternative<MoreNeeded>(parsed)) return;
    if (const auto* refusal = std::get_if<HttpRefusal>(&parsed))
      return respond(connection, lineResponse(refusal->status, refusal->reason), false);
    const ParsedRequest& whole = std::get<ParsedRequest>(parsed);
    connection.in.erase(0, whole.bytes);
    const bool keep_alive = whole.request.keep_alive;
    Reply reply = handler(whole.request);
    if (const auto* response = std::get_if<HttpResponse>(&reply)) {
      respond(connection, *response, keep_alive);
      continue;
    }
    connection.waits = true;
    connection.closes = !keep_alive;
    queues.push(std::move(std::get<LiveJob>(reply)),
                [box = mailbox, id = connection.id](HttpResponse response) {
                  box->put(id, std::move(response));
                });
  }
}

void Server::Parts::deliver() {
  for (Mailbox::Mail& mail : mailbox->take())
    for (Connection& connection : connections)
      if (connection.id == mail.connection) respond(connection, mail.response, !connection.closes);
}

// The wake-up, the listening socket, then the connections in their order.
std::vector<pollfd> Server::Parts::wishes() const {
  std::vector<pollfd> wishes{{mailbox->wake.number(), POLLIN, 0}, {socket.number(), POLLIN, 0}};
  for (const Connection& connection : connections) {
    short events = POLLRDHUP;
    if (!connection.waits && (!connection.closes || connection.drains)) events |= POLLIN;
    if (!connection.out.empty()) events |= POLLOUT;
    wishes.push_back({connection.socket.number(), events, 0});
  }
  return wishes;
}

void Server::Parts::dropOverdue() {
  const Clock::time_point now = Clock::now();
  for (Connection& connection : connections) {
    if (connection.waits) continue;
    const bool idle = connection.in.empty() && connection.out.empty();
    const std::chrono::seconds most(connection.drains ? kDrainSeconds
                                    : idle            ? kIdleSeconds
                                                      : kRequestSeconds);
    connection.lost = connection.lost || now - connection.since > most;
  }
  std::erase_if(connections, [](const Connection& connection) { return connection.lost; });
}

void Server::Parts::step(const Handler& handler, JobQueues& queues) {
  std::vector<pollfd> polled = wishes();
  const int ready = ::poll(polled.data(), polled.size(), kPoll_ms);
  if (ready < 0 && errno != EINTR) fail("poll", errno);
  deliver();
  const std::size_t count = connections.size();
  for (std::size_t i = 0; i < count && ready > 0; ++i) {
    Connection& connection = connections[i];
    const short events = polled[i + 2].revents;
    if (events & POLLIN) receive(connection);
    if (events & (POLLERR | POLLHUP | POLLRDHUP | POLLNVAL) && !(events & POLLIN))
      connection.lost = true;
  }
  for (Connection& connection : connections) {
    if (connection.lost) continue;
    handle(connection, handler, queues);
    if (!connection.out.empty()) transmit(connection);
  }
  if (polled[1].revents & POLLIN) accept();
  dropOverdue();
}

Server::Server(int port) : parts_(std::make_unique<Parts>(port)) {}
Server::~Server() = default;

int Server::port() const {
  return parts_->port;
}

void Server::run(const Handler& handler, JobQueues& queues, const std::function<bool()>& stop) {
  while (!stop()) parts_->step(handler, queues);
}

}  // namespace echocine::live
