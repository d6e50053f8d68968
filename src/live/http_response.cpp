#include "live/http_response.h"

#include <fmt/format.h>

namespace echocine::live {

namespace {

const char* statusWords(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 204:
      return "No Content";
    case 400:
      return "Bad Request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 408:
      return "Request Timeout";
    case 409:
      return "Conflict";
    case 410:
      return "Gone";
    case 413:
      return "Content Too Large";
    case 415:
      return "Unsupported Media Type";
    case 422:
      return "Unprocessable Content";
    case 431:
      return "Request Header Fields Too Large";
    case 500:
      return "Internal Server Error";
    case 501:
      return "Not Implemented";
    case 503:
      return "Service Unavailable";
    case 505:
      return "HTTP Version Not Supported";
    default:
      return "Status";
  }
}

}  // namespace

HttpResponse lineResponse(int status, std::string_view line) {
  HttpResponse response{status, "text/plain; charset=utf-8", std::string(line)};
  for (char& c : response.body)
    if ((c >= 0 && c < ' ') || c == 0x7f) c = ' ';
  response.body += '\n';
  return response;
}

std::string responseBytes(const HttpResponse& response, bool keep_alive) {
  const bool has_body = response.status != 204;
  std::string bytes =
      fmt::format("HTTP/1.1 {} {}\r\n", response.status, statusWords(response.status));
  if (has_body)
    bytes += fmt::format("Content-Type: {}\r\nContent-Length: {}\r\n", response.type,
                         response.body.size());
  bytes +=
      "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n"
      "Referrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n";
  // The ports of notebooks are not known. A frame shows the page only by its link with the token.
  bytes += response.framed ? "Content-Security-Policy: frame-ancestors 'self' http://localhost:* "
                             "http://127.0.0.1:*\r\n"
                           : "X-Frame-Options: DENY\r\n";
  bytes += keep_alive ? "Connection: keep-alive\r\n\r\n" : "Connection: close\r\n\r\n";
  if (has_body) bytes += response.body;
  return bytes;
}

}  // namespace echocine::live
