// Requests to a live session: what is parsed, and what is refused.

#include <gtest/gtest.h>

#include "live/access.h"
#include "live/http_request.h"
#include "live/http_response.h"

namespace echocine::live {
namespace {

int refusedWith(const std::string& bytes) {
  const auto parsed = parseRequest(bytes);
  const auto* refusal = std::get_if<HttpRefusal>(&parsed);
  return refusal ? refusal->status : 0;
}

TEST(LiveRequest, IsParsedWithItsBodyAndLeavesTheNextOne) {
  const std::string bytes =
      "POST /picture?a=1&token=ab HTTP/1.1\r\nHost: localhost:8\r\nContent-Length: 2\r\n"
      "X-Word:  two words \r\n\r\n{}GET / HTTP/1.1\r\n\r\n";
  const auto parsed = parseRequest(bytes);
  const auto* whole = std::get_if<ParsedRequest>(&parsed);
  ASSERT_NE(whole, nullptr);
  EXPECT_EQ(whole->request.method, "POST");
  EXPECT_EQ(whole->request.path, "/picture");
  EXPECT_EQ(whole->request.parameter("token"), "ab");
  EXPECT_EQ(whole->request.parameter("tok"), std::nullopt);
  ASSERT_NE(whole->request.header("x-word"), nullptr);
  EXPECT_EQ(*whole->request.header("x-word"), "two words");
  EXPECT_EQ(whole->request.body, "{}");
  EXPECT_EQ(bytes.substr(whole->bytes, 5), "GET /");
}

// Whatever the network cuts the bytes into, the same request comes out.
TEST(LiveRequest, NeedsMoreAtEveryPrefix) {
  const std::string bytes = "POST /png HTTP/1.1\r\nHost: h\r\nContent-Length: 3\r\n\r\n{ }";
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_TRUE(std::holds_alternative<MoreNeeded>(parseRequest(bytes.substr(0, n)))) << n;
  EXPECT_TRUE(std::holds_alternative<ParsedRequest>(parseRequest(bytes)));
}

TEST(LiveRequest, IsRefusedByItsHeaderAlone) {
  const std::string start = "POST / HTTP/1.1\r\n";
  EXPECT_EQ(refusedWith(start + "Content-Length: 1000000000\r\n\r\n"), 413);
  EXPECT_EQ(refusedWith(start + "Content-Length: 99999999999999999999999\r\n\r\n"), 413);
  EXPECT_EQ(refusedWith(start + "Content-Length: -1\r\n\r\n"), 400);
  EXPECT_EQ(refusedWith(start + "Content-Length: 1\r\nContent-Length: 2\r\n\r\n"), 400);
  EXPECT_EQ(refusedWith(start + "Transfer-Encoding: chunked\r\n\r\n"), 501);
  EXPECT_EQ(refusedWith("GET / HTTP/2\r\n\r\n"), 505);
  EXPECT_EQ(refusedWith("GET http://elsewhere/ HTTP/1.1\r\n\r\n"), 400);
  EXPECT_EQ(refusedWith("no request at all\r\n\r\n"), 400);
  EXPECT_EQ(refusedWith(start + "a line without a colon\r\n\r\n"), 400);
  EXPECT_EQ(refusedWith(std::string(kMostHeaderBytes, 'a')), 431);
  std::string many = start;
  for (std::size_t i = 0; i <= kMostHeaders; ++i) many += "A: b\r\n";
  EXPECT_EQ(refusedWith(many + "\r\n"), 431);
}

class LiveAccess : public ::testing::Test {
 protected:
  const Access access{8123, "0123456789abcdef"};
  HttpRequest request{"POST",
                      "/picture",
                      "",
                      {{"host", "127.0.0.1:8123"},
                       {"echocine-token", "0123456789abcdef"},
                       {"content-type", "application/json"}},
                      "{}"};
  int status() const {
    const auto refusal = refusalOf(request, access);
    return refusal ? refusal->status : 0;
  }
};

TEST_F(LiveAccess, TakesItsOwnPage) {
  EXPECT_EQ(status(), 0);
  request.headers.emplace_back("origin", "http://127.0.0.1:8123");
  EXPECT_EQ(status(), 0);
  request = {"GET", "/", "token=0123456789abcdef", {{"host", "localhost:8123"}}, ""};
  EXPECT_EQ(status(), 0);
}

TEST_F(LiveAccess, RefusesOtherNamesPagesAndTokens) {
  request.headers[0].second = "echocine.example:8123";
  EXPECT_EQ(status(), 403);
  request.headers[0].second = "127.0.0.1:8124";
  EXPECT_EQ(status(), 403);
  request.headers[0].second = "127.0.0.1:8123";
  for (const char* token : {"", "0123456789abcdee", "0123456789abcdef0"}) {
    request.headers[1].second = token;
    EXPECT_EQ(status(), 403) << token;
  }
  request.headers[1].second = access.token;
  request.headers.emplace_back("origin", "http://elsewhere.example");
  EXPECT_EQ(status(), 403);
  request.headers.back().second = "null";
  EXPECT_EQ(status(), 403);
}

TEST_F(LiveAccess, RefusesOtherMethodsAndTypes) {
  request.headers[2].second = "text/plain";
  EXPECT_EQ(status(), 415);
  request.method = "PUT";
  EXPECT_EQ(status(), 405);
  request = {"GET", "/", "", {{"host", "127.0.0.1:8123"}}, ""};
  EXPECT_EQ(status(), 403);
}

TEST(LiveToken, IsNeverTheSame) {
  const std::string one = randomToken(), other = randomToken();
  EXPECT_EQ(one.size(), 32u);
  EXPECT_NE(one, other);
}

TEST(LiveResponse, HasItsLengthAndNoLineOfARequest) {
  const std::string bytes = responseBytes(lineResponse(403, "no\r\nSet-Cookie: a"), false);
  EXPECT_TRUE(bytes.starts_with("HTTP/1.1 403 Forbidden\r\n"));
  EXPECT_TRUE(bytes.ends_with("\r\n\r\nno  Set-Cookie: a\n"));
  EXPECT_NE(bytes.find("Content-Length: 18\r\n"), std::string::npos);
}

}  // namespace
}  // namespace echocine::live
