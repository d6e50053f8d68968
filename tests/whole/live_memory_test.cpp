// Memory of a live session whose probe moves. ECHOCINE_LIVE_MOVES sets the number of moves, such as
// 10000.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "core/parallel.h"
#include "live/live_session.h"
#include "support/loop_scene.h"

namespace echocine::live {
namespace {

using namespace support;

double residentMegabytes() {
  std::ifstream file("/proc/self/statm");
  double total = 0, resident = 0;
  file >> total >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) * 1e-6;
}

TEST(LiveMemory, StaysFlatWhileTheProbeMoves) {
#ifdef ECHOCINE_SANITIZED
  GTEST_SKIP() << "a sanitizer keeps freed memory";
#endif
  const TempFolder folder;
  const std::filesystem::path file = writeBall(folder, ballScene(8));
  std::optional<LiveSession> session;
  withThreads(1, [&] { session.emplace(file, std::filesystem::path()); });
  const auto move = [&](int i) {
    const std::string body = fmt::format(
        R"({{"effort": "moving", "frame": {}, "keys": {{"probe.apex": [{}, 0, 0], "probe.axis": [{}, 0.02, 1],
           "probe.lateral": [1, 0, 0]}}}})",
        i % 8, 0.3 * std::sin(0.1 * i), 0.2 * std::sin(0.07 * i));
    auto reply = session->answer({"POST", "/picture", "", {}, body});
    HttpResponse response;
    withThreads(1, [&] { response = std::get<LiveJob>(reply).run(); });
    ASSERT_EQ(response.status, 200) << response.body;
  };
  const char* wanted = std::getenv("ECHOCINE_LIVE_MOVES");
  const int moves = wanted ? std::atoi(wanted) : 400, first = 100;
  for (int i = 0; i < first; ++i) move(i);
  const double before = residentMegabytes();
  for (int i = first; i < first + moves; ++i) move(i);
  const double grown = residentMegabytes() - before;
  // A picture has 19 kB: if a move kept one, 400 moves would keep 8 MB.
  EXPECT_LT(grown, 3) << moves << " moves";
  if (wanted) fmt::print("{} moves: {:+.1f} MB at {:.0f} MB\n", moves, grown, before);
}

}  // namespace
}  // namespace echocine::live
