#pragma once
// HTTP requests as text: a parser without sockets, with bounds on everything that a client sends.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace echocine::live {

// Bounds of a request. Our choice: requests of the page have under 2 kB of header and under 8 kB
// of body.
inline constexpr std::size_t kMostHeaderBytes = 16 << 10;
inline constexpr std::size_t kMostHeaders = 64;
inline constexpr std::size_t kMostBodyBytes = 256 << 10;

struct HttpRequest {
  std::string method, path;                                  // path without the query
  std::string query;                                         // behind '?', as sent
  std::vector<std::pair<std::string, std::string>> headers;  // names in lower case
  std::string body;
  bool keep_alive = true;

  // The value of a header by its name in lower case; nullptr if absent.
  const std::string* header(std::string_view name) const;
  // The value of `name=value` in the query; none if absent. No percent-decoding.
  std::optional<std::string> parameter(std::string_view name) const;
};

// The bytes do not hold a whole request yet.
struct MoreNeeded {};

// A rejected request: HTTP status and one line of reason. The connection must be closed.
struct HttpRefusal {
  int status = 400;
  std::string reason;
};

struct ParsedRequest {
  HttpRequest request;
  std::size_t bytes = 0;  // consumed from the start
};

// Parses the request at the start of `bytes` (HTTP/1.0 and 1.1). A header or a body beyond the
// bounds is refused as soon as its size is known: 431 and 413. Chunked bodies are refused: 501. A
// header that appears twice is refused if it is Host, Content-Length or Origin.
std::variant<MoreNeeded, ParsedRequest, HttpRefusal> parseRequest(std::string_view bytes);

}  // namespace echocine::live
