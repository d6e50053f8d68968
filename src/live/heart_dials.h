#pragma once
// The dials of a scene whose meshes are those of a parametric heart, and other hearts in their
// place.

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "motion/heart/heart_scene.h"
#include "motion/heart/recording.h"
#include "scene/scene.h"
#include "scene/scene_reader.h"

namespace echocine::live {

// Dials that a page has changed, by the heart's keys, in its units; amplitudes by segment from 1.
struct HeartChange {
  std::map<std::string, double> dials;
  std::map<int, double> segments;

  std::string name() const;  // the same for equal changes
};

// A heart in place of the scene's own.
struct OtherHeart {
  std::string text;           // of the scene, with meshes named without a folder
  NamedMeshes meshes;         // by these names
  heart::ProbePose standard;  // of the scene's view, on this heart. World, m
};

class HeartDials {
 public:
  // None unless all keyframes of the scene are patterns in one folder with a truth.json that
  // `echocine heart` wrote, in mm. `text` is the scene's. `truth` replaces this file for meshes in
  // memory; empty: the file.
  static std::optional<HeartDials> of(const Scene& scene, const std::string& text,
                                      const std::string& truth = {});

  // Key, unit, lo, hi, value and meaning of each dial after a change, since some follow others, and
  // the amplitudes of the segments. Throws SceneError for an unknown dial and a value out of range.
  nlohmann::ordered_json json(const HeartChange& change = {}) const;

  // Runs inside withThreads(). Throws SceneError for an unknown dial, a value out of range, and a
  // heart that has no valid shape.
  OtherHeart made(const HeartChange& change, const std::string& text) const;

  // The standard pose of the scene's view on the scene's own heart.
  const heart::ProbePose& ownStandard() const;

  // Writes meshes and truth of made(change) into a folder, which must be absent or empty. Throws as
  // writeHeart().
  void write(const HeartChange& change, const std::filesystem::path& folder) const;

  // The text of made() with its meshes in a folder, which is written as given, with a slash.
  static std::string withFolder(const std::string& text, const std::string& folder);

 private:
  struct Own {
    std::once_flag once;
    heart::View view = heart::View::a4c;
    heart::ProbePose standard;
  };
  bool readTruth(const std::string& truth);  // false: of something else
  heart::Parameters parametersWith(const HeartChange& change) const;
  const Own& own() const;

  std::map<std::string, double> given_;  // dials that do not follow others
  heart::Parameters parameters_;
  heart::KeyframeSpacing spacing_ = heart::KeyframeSpacing::by_motion;
  int keyframes_ = 0;
  Pose pose_;         // of the scene's probe
  std::string file_;  // of the scene, in messages
  std::shared_ptr<Own> own_ = std::make_shared<Own>();
};

}  // namespace echocine::live
