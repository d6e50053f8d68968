// Random requests to a live session: each has an answer, and the session goes on.
// ECHOCINE_LIVE_FUZZ_S prolongs the test to that many seconds.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <climits>
#include <cstdlib>
#include <random>
#include <set>

#include "core/parallel.h"
#include "core/stop.h"
#include "live/live_session.h"
#include "scene/scene_keys.h"
#include "support/loop_scene.h"

namespace echocine::live {
namespace {

using namespace support;
using Clock = std::chrono::steady_clock;

const Access kAccess{8123, "0123456789abcdef"};

// Requests that are nearly right: valid fields with random values, and sometimes random bytes.
class Requests {
 public:
  explicit Requests(unsigned seed) : random_(seed) {
    for (const SceneKey& key : sceneKeys()) keys_.push_back(key.fullName());
  }

  std::string next() {
    const std::string body = bodyText();
    std::string bytes = fmt::format(
        "POST {} HTTP/1.1\r\nHost: 127.0.0.1:8123\r\nEchocine-Token: {}\r\n"
        "Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{}",
        oneOf({"/picture", "/png", "/scene", "/save", "/view", "/truth", "/effects", "/cost",
               "/heart", "/loop", "/nothing"}),
        kAccess.token, body.size(), body);
    if (chance(5))
      for (int i = below(6); i >= 0; --i)
        bytes[static_cast<std::size_t>(below(static_cast<int>(bytes.size())))] =
            static_cast<char>(below(256));
    return bytes;
  }

 private:
  int below(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
  bool chance(int of) { return below(of) == 0; }
  std::string oneOf(const std::vector<std::string>& words) {
    return words[static_cast<std::size_t>(below(static_cast<int>(words.size())))];
  }

  std::string value(int depth = 0) {
    switch (below(depth > 3 ? 6 : 9)) {
      case 0:
        return std::to_string(below(300));
      case 1:
        return fmt::format("{}", (below(2000) - 1000) / 8.0);
      case 2:
        return oneOf({"1e308", "-1e308", "1e999", "-0", "9223372036854775808", "1e-320"});
      case 3:
        return oneOf({"true", "false", "null"});
      case 4:
        return "\"" +
               oneOf({"scanner", "paper", "a4c", "mp4", "still", "moving", "../x.toml", "a.toml",
                      "\\n[x]", "\\u0000", "\xff", "labels", "wall"}) +
               "\"";
      case 5:
        return "\"" + std::string(static_cast<std::size_t>(below(200)), 'a') + "\"";
      case 6:
        return std::string(static_cast<std::size_t>(below(40)), '[') + "1";
      default: {
        std::string list;
        for (int i = below(5); i > 0; --i) list += (list.empty() ? "" : ", ") + value(depth + 1);
        return chance(2) ? "[" + list + "]" : "{\"a\": " + value(depth + 1) + "}";
      }
    }
  }

  std::string keysText() {
    std::string text;
    for (int i = below(4); i > 0; --i)
      text += fmt::format(
          "{}\"{}\": {}", text.empty() ? "" : ", ",
          chance(3) ? oneOf({"probe.apex", "probe.axis", "probe.lateral"}) : oneOf(keys_),
          chance(3) ? "[0.1, 0.2, 1]" : value());
    return "{" + text + "}";
  }

  std::string bodyText() {
    if (chance(20)) return std::string(static_cast<std::size_t>(below(100000)), '[');
    if (chance(3))
      return fmt::format(
          R"({{"frame": {}, "view": "a4c", "name": "a.toml", "replace": true, "format": "gif"}})",
          below(5));
    std::string text = "\"keys\": " + keysText();
    for (const char* field : {"frame", "effort", "name", "replace", "view", "dials", "segments",
                              "format", "layers", "other"})
      if (chance(4)) text += fmt::format(", \"{}\": {}", field, value());
    if (chance(2)) text += R"(, "effort": "moving")";
    if (chance(4)) text += R"(, "layers": ["labels", "wall"])";
    return "{" + text + "}";
  }

  std::mt19937 random_;
  std::vector<std::string> keys_;
};

// As the server does. A job gives way after `most` checkpoints, however fast the machine is.
HttpResponse answerTo(LiveSession& session, const std::string& bytes, int most) {
  const auto parsed = parseRequest(bytes);
  if (const auto* refusal = std::get_if<HttpRefusal>(&parsed))
    return lineResponse(refusal->status, refusal->reason);
  if (std::holds_alternative<MoreNeeded>(parsed)) return {204, {}, {}};
  const HttpRequest& request = std::get<ParsedRequest>(parsed).request;
  if (const auto refusal = refusalOf(request, kAccess))
    return lineResponse(refusal->status, refusal->reason);
  auto reply = session.answer(request);
  if (auto* response = std::get_if<HttpResponse>(&reply)) return *response;
  HttpResponse response{204, {}, {}};
  std::atomic<int> polls{0};
  try {
    stoppable([&] { return ++polls > most; },
              [&] { withThreads(1, [&] { response = std::get<LiveJob>(reply).run(); }); });
  } catch (const Stopped&) {
  }
  return response;
}

TEST(LiveFuzz, EveryRequestHasAnAnswerAndTheSessionGoesOn) {
  const TempFolder folder;
  SceneText text = ballScene(4);
  text.probe["lines"] = "12";
  text.probe["samples"] = "64";
  const std::filesystem::path file = writeBall(folder, text);
  std::optional<LiveSession> session;
  withThreads(1, [&] { session.emplace(file, std::filesystem::path()); });
  const std::string good =
      "POST /png HTTP/1.1\r\nHost: 127.0.0.1:8123\r\nEchocine-Token: 0123456789abcdef\r\n"
      "Content-Type: application/json\r\nContent-Length: 11\r\n\r\n{\"frame\":1}";
  const std::string before = answerTo(*session, good, INT_MAX).body;
  ASSERT_TRUE(before.starts_with("\x89PNG"));

  const char* wanted = std::getenv("ECHOCINE_LIVE_FUZZ_S");
  const auto end = Clock::now() + std::chrono::seconds(wanted ? std::atoi(wanted) : 0);
  const std::set<int> accepted{200, 204, 400, 403, 404, 405, 409,
                               410, 413, 415, 422, 431, 501, 505};
  Requests requests(20251125);
  std::size_t count = 0, answered = 0;
  for (; count < 250 || Clock::now() < end; ++count) {
    const std::string bytes = requests.next();
    const HttpResponse response = answerTo(*session, bytes, 3000);
    answered += response.status == 200;
    ASSERT_TRUE(accepted.contains(response.status)) << response.status << response.body << "\n"
                                                    << bytes;
    if (response.status >= 400) {
      ASSERT_EQ(std::count(response.body.begin(), response.body.end(), '\n'), 1) << bytes;
    }
  }
  EXPECT_GT(answered, count / 50) << "no request is right";
  EXPECT_EQ(answerTo(*session, good, INT_MAX).body, before);
  if (wanted) fmt::print("{} requests, {} of them with a picture or a value\n", count, answered);
}

}  // namespace
}  // namespace echocine::live
