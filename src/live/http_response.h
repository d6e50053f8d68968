#pragma once
// HTTP responses as bytes.

#include <string>
#include <string_view>

#include "live/http_request.h"

namespace echocine::live {

struct HttpResponse {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  bool framed = false;  // pages of this machine may show it in a frame
};

// One line with a status. Control characters become spaces.
HttpResponse lineResponse(int status, std::string_view line);

// The response with its header. No response may be cached, framed by another page unless it is
// `framed`, or read as another type. 204 has no body.
std::string responseBytes(const HttpResponse& response, bool keep_alive);

}  // namespace echocine::live
