#include "live/picture_bytes.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace echocine::live {

namespace {

using Json = nlohmann::ordered_json;

Json volumesJson(const Volumes& volumes) {
  Json json = Json::object();
  for (const auto& [name, volume_ml] : volumes) json[name] = volume_ml;
  return json;
}

}  // namespace

std::string pictureBytes(const LivePicture& picture, const Scene& scene, Effort effort) {
  const bool moves = effort == Effort::moving;
  const std::string json = Json({{"frame", picture.time.frame},
                                 {"frames", picture.frames},
                                 {"time_s", picture.time.time_s},
                                 {"phase", picture.time.phase},
                                 {"width", picture.image.width},
                                 {"height", picture.image.height},
                                 {"effort", moves ? "moving" : "still"},
                                 {"quality", qualityWords(scene, effort)},
                                 {"ms", picture.milliseconds},
                                 {"prepared_ms", picture.prepared_ms},
                                 {"warnings", picture.warnings},
                                 {"volumes_ml", volumesJson(picture.volumes_ml)}})
                               .dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string bytes;
  bytes.reserve(4 + json.size() + picture.image.pixels.size());
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(json.size() >> (8 * i) & 0xFF);
  bytes += json;
  bytes.append(reinterpret_cast<const char*>(picture.image.pixels.data()),
               picture.image.pixels.size());
  return bytes;
}

}  // namespace echocine::live
