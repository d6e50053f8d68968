#include "live/access.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <array>
#include <cstdint>

#include "core/error.h"

namespace echocine::live {

namespace {

// Takes the same time wherever the texts differ.
bool equalTokens(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

}  // namespace

std::string randomToken() {
  std::array<std::uint8_t, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw JobError("live: the system gives no random numbers for a token");
  std::string token;
  for (const std::uint8_t byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

std::optional<HttpRefusal> refusalOf(const HttpRequest& request, const Access& access) {
  const std::string* host = request.header("host");
  const std::string by_number = fmt::format("127.0.0.1:{}", access.port);
  const std::string by_name = fmt::format("localhost:{}", access.port);
  if (!host || (*host != by_number && *host != by_name))
    return HttpRefusal{403, fmt::format("Host is not {}", by_number)};
  const std::string* origin = request.header("origin");
  if (origin && *origin != "http://" + *host) return HttpRefusal{403, "Origin is another page"};
  const bool posts = request.method == "POST";
  if (!posts && request.method != "GET") return HttpRefusal{405, "only GET and POST are accepted"};
  const std::string* sent = request.header(kTokenHeader);
  const std::string token =
      posts ? (sent ? *sent : std::string()) : request.parameter("token").value_or("");
  if (!equalTokens(token, access.token))
    return HttpRefusal{403,
                       "the token is absent or wrong: open the link that echocine has printed"};
  const std::string* type = request.header("content-type");
  if (posts && (!type || *type != "application/json"))
    return HttpRefusal{415, "Content-Type is not application/json"};
  return std::nullopt;
}

}  // namespace echocine::live
