#pragma once
// The scene of a live session: a text, and changes of its keys that a page requests.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "scene/scene_keys.h"
#include "scene/scene_reader.h"

namespace echocine::live {

// Can the key be changed while a session runs?
bool isLiveKey(const SceneKey& key);

class LiveScene {
 public:
  // Reads the file. A probe placed by probe.view gets its pose as apex, axis and lateral, so that
  // it can be moved. Throws SceneError like readScene() and placed().
  explicit LiveScene(const std::filesystem::path& file);
  // A text in memory. `file` is its name in messages and the base of its paths; `meshes` are its
  // meshes, empty: in files.
  LiveScene(std::filesystem::path file, std::string text, NamedMeshes meshes);
  // Another text in place of that of `of`, with its meshes in memory.
  LiveScene(const LiveScene& of, std::string text, NamedMeshes meshes);

  const std::filesystem::path& file() const { return file_; }
  const std::string& text() const { return text_; }  // with the pose as keys
  bool isInMemory() const { return !meshes_.empty(); }

  // The text with keys changed: a JSON object of full key -> value in the key's unit; null removes
  // the key, so that its default applies. Accepted are the keys of probe, acquisition, effects,
  // signal, speckle, trabeculae, artefacts and accuracy, except probe.view and its shift and
  // angles. Throws SceneError naming the key.
  std::string textWith(const nlohmann::ordered_json& keys) const;

  // A text of textWith() as a scene. Throws SceneError naming key and accepted values.
  Scene read(const std::string& text) const;

  struct Change {
    std::string key, from, to;  // as TOML; empty: absent
  };
  // Keys whose values differ from those of the file, in alphabetical order.
  std::vector<Change> changes(const std::string& text) const;

 private:
  std::filesystem::path file_;
  std::string given_, text_;  // of the file, and with the pose as keys
  NamedMeshes meshes_;        // empty: in files
};

}  // namespace echocine::live
