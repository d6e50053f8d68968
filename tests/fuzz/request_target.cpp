#include <nlohmann/json.hpp>

#include "live/access.h"
#include "live/http_request.h"
#include "live/http_response.h"
#include "live/live_scene.h"
#include "promises.h"
#include "scene/toml_flat.h"
#include "targets.h"

namespace echocine::fuzz {

namespace {

constexpr const char* kScene =
    "[probe]\napex = [0, 0, 0]\naxis = [0, 0, 1]\nlateral = [1, 0, 0]\nsector_deg = 70\n"
    "depth_mm = 150\nfrequency_mhz = 2.5\n[motion]\nmesh_unit = \"mm\"\n[signal]\ngain_db = 1\n"
    "[[structure]]\nname = \"wall\"\nmedium = \"myocardium\"\nkeyframes = \"wall.obj\"\n";

// Keys that are accepted give a text that is TOML and differs in these keys only.
void promiseEdits(const std::string& body) {
  static const live::LiveScene kLive(scratchFile("scene.toml", kScene));
  const auto json = nlohmann::ordered_json::parse(body, nullptr, false);
  if (json.is_discarded()) return;
  accepts([&] {
    const std::string text = kLive.textWith(json);
    for (const live::LiveScene::Change& change : kLive.changes(text))
      promise(json.contains(change.key), change.key + " changed by another key");
  });
}

}  // namespace

// A client's bytes, up to the scene that its body asks for.
void request(std::string_view bytes) {
  const auto parsed = live::parseRequest(bytes);
  if (const auto* refusal = std::get_if<live::HttpRefusal>(&parsed)) {
    promise(refusal->status >= 400 && refusal->status < 600, "a refusal with another status");
    promise(!refusal->reason.empty(), "a refusal without a word");
    return;
  }
  if (std::holds_alternative<live::MoreNeeded>(parsed)) {
    promise(bytes.size() < live::kMostHeaderBytes + live::kMostBodyBytes, "bytes without a bound");
    return;
  }
  const auto& whole = std::get<live::ParsedRequest>(parsed);
  promise(whole.bytes > 0 && whole.bytes <= bytes.size(), "another number of bytes than were sent");
  promise(whole.request.body.size() <= live::kMostBodyBytes, "a body beyond its bound");
  promise(whole.request.headers.size() <= live::kMostHeaders, "more headers than their bound");
  (void)live::refusalOf(whole.request, {8080, "0123456789abcdef0123456789abcdef"});
  promiseEdits(whole.request.body);
}

}  // namespace echocine::fuzz
