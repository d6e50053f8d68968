#include "live/connection.h"

#include <sys/eventfd.h>
#include <sys/socket.h>

#include <cerrno>

namespace echocine::live {

namespace {

constexpr std::size_t kReadBytes = 64 << 10;

}  // namespace

Mailbox::Mailbox() : wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

void Mailbox::put(std::uint64_t connection, HttpResponse response) {
  {
    const std::lock_guard lock(mutex);
    mails.push_back({connection, std::move(response)});
  }
  const std::uint64_t one = 1;
  if (::write(wake.number(), &one, sizeof one) < 0) return;  // full: a wake-up is pending
}

std::vector<Mailbox::Mail> Mailbox::take() {
  std::uint64_t count = 0;
  if (::read(wake.number(), &count, sizeof count) < 0) count = 0;  // empty: nothing is new
  const std::lock_guard lock(mutex);
  return std::exchange(mails, {});
}

void respond(Connection& connection, const HttpResponse& response, bool keep_alive) {
  connection.out += responseBytes(response, keep_alive);
  connection.closes = connection.closes || !keep_alive;
  connection.waits = false;
  connection.since = std::chrono::steady_clock::now();
}

void receive(Connection& connection) {
  std::vector<char> bytes(kReadBytes);
  const ssize_t count = ::recv(connection.socket.number(), bytes.data(), bytes.size(), 0);
  if (count > 0 && connection.drains) {
    return;
  } else if (count > 0) {
    if (connection.in.empty()) connection.since = std::chrono::steady_clock::now();
    connection.in.append(bytes.data(), static_cast<std::size_t>(count));
  } else if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
    connection.lost = true;
  }
}

void transmit(Connection& connection) {
  while (connection.sent < connection.out.size()) {
    const ssize_t count =
        ::send(connection.socket.number(), connection.out.data() + connection.sent,
               connection.out.size() - connection.sent, MSG_NOSIGNAL);
    if (count < 0) {
      connection.lost = connection.lost || (errno != EAGAIN && errno != EINTR);
      return;
    }
    connection.sent += static_cast<std::size_t>(count);
  }
  connection.out.clear();
  connection.sent = 0;
  if (!connection.closes) return;
  // Closing with unread bytes would reset the connection before the client reads the response.
  ::shutdown(connection.socket.number(), SHUT_WR);
  connection.drains = true;
  connection.since = std::chrono::steady_clock::now();
}

}  // namespace echocine::live
