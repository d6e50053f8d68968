#include "live/live.h"

#include <fmt/format.h>

#include <utility>

#include "core/parallel.h"
#include "core/stop.h"
#include "live/access.h"
#include "live/job_queue.h"
#include "live/live_session.h"
#include "live/server.h"

namespace echocine::live {

void serveLive(const LiveOptions& options,
               const std::function<void(const std::string& link)>& listening,
               const std::function<void(const std::string&)>& warn,
               const std::function<bool()>& stop) {
  Server server(options.port);  // first: a taken port costs no reading of meshes
  std::unique_ptr<LiveSession> session;
  stoppable(stop, [&] {
    withThreads(options.threads, [&] {
      LiveScene scene = options.text ? LiveScene(options.scene, *options.text, options.meshes)
                                     : LiveScene(options.scene);
      session =
          std::make_unique<LiveSession>(std::move(scene), options.record, options.heart_truth);
    });
  });
  for (const std::string& warning : session->warnings()) warn(warning);
  const Access access{server.port(), randomToken()};
  const auto handler = [&](const HttpRequest& request) -> Server::Reply {
    if (const auto refusal = refusalOf(request, access))
      return lineResponse(refusal->status, refusal->reason);
    auto reply = session->answer(request);
    if (auto* page = std::get_if<HttpResponse>(&reply)) page->framed = options.framed;
    return reply;
  };
  JobQueues queues(options.threads);
  listening(fmt::format("http://127.0.0.1:{}/?token={}", access.port, access.token));
  server.run(handler, queues, stop);
}

}  // namespace echocine::live
