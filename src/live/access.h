#pragma once
// Who may use the server: the page that it has served itself, with the token of its link.

#include <optional>
#include <string>
#include <string_view>

#include "live/http_request.h"

namespace echocine::live {

inline constexpr std::string_view kTokenHeader = "echocine-token";

struct Access {
  int port = 0;
  std::string token;
};

// 128 random bits of the system as hexadecimal digits. Throws JobError.
std::string randomToken();

// None if the request is accepted. 403 if Host is neither 127.0.0.1 nor localhost with this port
// (another name could be bound to this address by its owner), if Origin is another one, or if the
// token is absent or wrong. GET takes the token from the query, POST from the header. POST needs
// the type application/json, which no form of another page can send: 415.
std::optional<HttpRefusal> refusalOf(const HttpRequest& request, const Access& access);

}  // namespace echocine::live
