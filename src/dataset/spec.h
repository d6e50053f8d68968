#pragma once
// What a dataset is to be: the spec file in, a checked struct out.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/populations.h"
#include "scene/scene.h"

namespace echocine::dataset {

// A drawn quantity. Its name says whose it is: "heart.ef", "offset.tilt_deg",
// "scene.signal.gain_db", "subject.age".
struct Parameter {
  std::string name;
  Distribution distribution;
  SourcePlace place;  // in the spec; none of those built in
};

// Heart, subject and acquisition are drawn once a heart, the rest once a view.
bool isOfHeart(std::string_view name);

struct Population {
  std::string name;
  double weight = 1;
  std::vector<Parameter> parameters;  // "heart." each
};

// A scene of the user, which brings its own heart.
struct UserScene {
  std::string name;  // as the spec has it
  std::filesystem::path file;
  std::string text;
  Acquisition acquisition;  // where nothing is drawn
};

// Parameters drawn together (draws.h).
struct CorrelatedGroup {
  std::vector<std::string> names;
  std::vector<double> factor;  // Cholesky factor of the correlations, row by row
};

enum class Split { train, val, test };

struct Spec {
  std::filesystem::path file;
  std::string digest;  // SHA-256 of what the file says and of the program's version
  std::string text;    // of the file
  std::string name, licence;
  std::uint64_t seed = 1;
  int hearts = 0;
  std::vector<View> views;
  std::vector<std::string> layouts;
  std::array<double, 3> split{0.8, 0.1, 0.1};  // shares by heart: train, val, test
  int keyframes = 16;
  int picture_px = 448;      // side of the square picture
  double resolution_mm = 0;  // largest pixel; 0: whatever picture_px gives
  std::vector<std::string> truth;
  int track_count = 300;
  int shard_mb = 1000;  // of WebDataset, 10^6 bytes; a loop that is larger has a shard of its own
  std::vector<Parameter> parameters;    // of all hearts; they win over the populations'
  std::vector<UserScene> scenes;        // in place of the parametric heart; empty: none
  std::vector<Population> populations;  // at least one; of scenes one each, in their order
  std::vector<CorrelatedGroup> correlated;

  std::size_t loops() const { return static_cast<std::size_t>(hearts) * views.size(); }
  bool has(std::string_view layout) const;
  bool wants(std::string_view truth_kind) const;
  bool wantsTracks() const;  // as truth, or for a layout
  // Hearts in their order: the first ones train, then validation, then test. They are independent
  // draws, and some loaders split by number. All draws of one user's scene are in one split.
  Split splitOf(int heart) const;
  // Of a drawn heart: the scenes take turns. Precondition: there are some.
  const UserScene& sceneOf(int heart) const;
  // All that is drawn for a heart of a population.
  std::vector<Parameter> parametersOf(const Population& population) const;
};

// MyoTracker's loader passes over loops with fewer frames.
inline constexpr int kLeastTrackedFrames = 30;

// Names of the layouts that loops are written in.
std::vector<std::string> layoutNames();

// Throws SceneError where a parameter may be what a scene, or a layout the loops, cannot hold.
void checkSpec(const Spec& spec);

// Throws SceneError `file:line: key: what is wrong, what is accepted`.
Spec readSpec(const std::filesystem::path& file);
Spec parseSpec(std::string_view text, const std::filesystem::path& file);

}  // namespace echocine::dataset
