#include "output/scene_sha256.h"

#include <nlohmann/json.hpp>

#include "core/hash.h"
#include "scene/scene_json.h"

namespace echocine {

std::string sceneSha256(const Scene& scene, const MeshMotion& motion) {
  Sha256 hash;
  hash.update(ECHOCINE_VERSION);
  hash.update(sceneJson(scene).dump());
  hash.update(mediaJson(scene).dump());
  hash.update(motion.inputSha256());
  return hash.hex();
}

}  // namespace echocine
