#include "live/http_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace echocine::live {

namespace {

bool isTokenCharacter(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
         std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

bool isToken(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), isTokenCharacter);
}

// Visible ASCII, as a request target has.
bool isVisible(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

HttpRefusal bad(std::string reason) {
  return {400, std::move(reason)};
}

// "GET /path?query HTTP/1.1"
std::optional<HttpRefusal> readStartLine(std::string_view line, HttpRequest& request) {
  const std::size_t first = line.find(' '), second = line.find(' ', first + 1);
  if (first == std::string_view::npos || second == std::string_view::npos)
    return bad("the first line is not METHOD PATH VERSION");
  const std::string_view method = line.substr(0, first), version = line.substr(second + 1);
  const std::string_view target = line.substr(first + 1, second - first - 1);
  if (!isToken(method)) return bad("the method is not a token");
  if (target.empty() || target.front() != '/' || !isVisible(target))
    return bad("the path does not start with / or has characters that need percent-encoding");
  if (version != "HTTP/1.1" && version != "HTTP/1.0")
    return HttpRefusal{505, "only HTTP/1.0 and HTTP/1.1 are spoken"};
  request.method = method;
  const std::size_t question = target.find('?');
  request.path = target.substr(0, question);
  if (question != std::string_view::npos) request.query = target.substr(question + 1);
  request.keep_alive = version == "HTTP/1.1";
  return std::nullopt;
}

std::optional<HttpRefusal> readHeader(std::string_view line, HttpRequest& request) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || !isToken(line.substr(0, colon)))
    return bad("a header line is not NAME: VALUE");
  const std::string name = lowerCase(line.substr(0, colon));
  const std::string_view value = trimmed(line.substr(colon + 1));
  if (std::any_of(value.begin(), value.end(),
                  [](char c) { return (c >= 0 && c < ' ' && c != '\t') || c == 0x7f; }))
    return bad(fmt::format("the header {} has control characters", name));
  // Two values that contradict each other would be read differently by different programs.
  if ((name == "host" || name == "content-length" || name == "origin") && request.header(name))
    return bad(fmt::format("the header {} appears twice", name));
  if (request.headers.size() == kMostHeaders)
    return HttpRefusal{431, fmt::format("more than {} headers", kMostHeaders)};
  request.headers.emplace_back(name, value);
  return std::nullopt;
}

// The number of bytes behind the header, or why it is refused.
std::variant<std::size_t, HttpRefusal> bodySize(const HttpRequest& request) {
  if (request.header("transfer-encoding"))
    return HttpRefusal{501, "bodies in chunks are not accepted, send Content-Length"};
  const std::string* length = request.header("content-length");
  if (!length) return std::size_t{0};
  std::size_t size = 0;
  const auto [end, error] = std::from_chars(length->data(), length->data() + length->size(), size);
  const bool whole = end == length->data() + length->size() && !length->empty();
  if (whole && error == std::errc() && size <= kMostBodyBytes) return size;
  // A number too large for the type is a body too large, too.
  if (whole && (error == std::errc() || error == std::errc::result_out_of_range))
    return HttpRefusal{413, fmt::format("the body is over {} bytes", kMostBodyBytes)};
  return bad("Content-Length is not a number");
}

void readConnection(HttpRequest& request) {
  const std::string* connection = request.header("connection");
  if (connection && lowerCase(*connection) == "close") request.keep_alive = false;
}

}  // namespace

const std::string* HttpRequest::header(std::string_view name) const {
  const auto found = std::find_if(headers.begin(), headers.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  return found == headers.end() ? nullptr : &found->second;
}

std::optional<std::string> HttpRequest::parameter(std::string_view name) const {
  std::string_view rest = query;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('&'), rest.size());
    const std::string_view part = rest.substr(0, end);
    if (part.starts_with(name) && part.substr(name.size()).starts_with('='))
      return std::string(part.substr(name.size() + 1));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return std::nullopt;
}

std::variant<MoreNeeded, ParsedRequest, HttpRefusal> parseRequest(std::string_view bytes) {
  const std::size_t end = bytes.substr(0, kMostHeaderBytes).find("\r\n\r\n");
  if (end == std::string_view::npos) {
    if (bytes.size() >= kMostHeaderBytes)
      return HttpRefusal{431, fmt::format("the header is over {} bytes", kMostHeaderBytes)};
    return MoreNeeded{};
  }
  ParsedRequest parsed;
  HttpRequest& request = parsed.request;
  std::string_view head = bytes.substr(0, end);
  for (bool first = true; first || !head.empty(); first = false) {
    const std::size_t line_end = std::min(head.find("\r\n"), head.size());
    const std::string_view line = head.substr(0, line_end);
    if (auto refusal = first ? readStartLine(line, request) : readHeader(line, request))
      return *refusal;
    head.remove_prefix(std::min(line_end + 2, head.size()));
  }
  const auto size = bodySize(request);
  if (const auto* refusal = std::get_if<HttpRefusal>(&size)) return *refusal;
  const std::size_t body = std::get<std::size_t>(size), start = end + 4;
  if (bytes.size() - start < body) return MoreNeeded{};
  readConnection(request);
  request.body = bytes.substr(start, body);
  parsed.bytes = start + body;
  return parsed;
}

}  // namespace echocine::live
