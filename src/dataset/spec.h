#pragma once
// The specification of a dataset: the spec file in, a checked struct out.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/populations.h"
#include "scene/scene.h"

namespace echocine::dataset {

// A drawn quantity. Its name contains its owner: "heart.ef", "offset.tilt_deg",
// "scene.signal.gain_db", "subject.age".
struct Parameter {
  std::string name;
  Distribution distribution;
  SourcePlace place;  // in the spec; empty for built-in ones
};

// Heart, subject, acquisition, trabeculae and leaflets are drawn once per heart, the rest once per
// view.
bool isOfHeart(std::string_view name);

struct Population {
  std::string name;
  double weight = 1;
  std::vector<Parameter> parameters;  // "heart." each
  // Group in heart::heartGroups() of jointly drawn dials (index_draws.h), beside the parameters.
  std::optional<std::size_t> group{};
};

// A scene of the user, with its own heart.
struct UserScene {
  std::string name;  // as in the spec
  std::filesystem::path file;
  std::string text;
  Acquisition acquisition;  // used for values that are not drawn
};

// Correlated parameters (draws.h).
struct CorrelatedGroup {
  std::vector<std::string> names;
  std::vector<double> factor;  // Cholesky factor of the correlations, row by row
};

enum class Split { train, val, test };

struct Spec {
  std::filesystem::path file;
  std::string digest;        // SHA-256 of the file's content and of the program's version
  std::string heart_digest;  // the same without the keys that can grow (growth.h)
  std::string text;          // of the file
  std::string name, licence;
  std::uint64_t seed = 1;
  int hearts = 0;
  std::vector<int> blocks;  // hearts by block, in the order of growth; at least one
  std::vector<View> views;
  std::vector<std::string> layouts;
  std::array<double, 3> split{0.8, 0.1, 0.1};  // shares by heart: train, val, test
  int keyframes = 16;
  int picture_px = 448;      // side of the square picture
  double resolution_mm = 0;  // largest pixel; 0: determined by picture_px
  std::vector<std::string> truth;
  int track_count = 300;
  // Layouts whose ejection fraction is of the exact volumes; the others have that of the tracings.
  std::vector<std::string> exact_ef;
  bool nnunet_all = false;            // nnU-Net's labels are those of structure_labels.h
  int shard_mb = 1000;                // of WebDataset, 10^6 bytes; a larger loop has its own shard
  std::vector<Parameter> parameters;  // of all hearts; they override the populations'
  std::vector<UserScene> scenes;      // instead of the parametric heart; may be empty
  std::vector<Population> populations;  // at least one; one per scene, in their order
  std::vector<CorrelatedGroup> correlated;

  std::size_t loops() const { return static_cast<std::size_t>(hearts) * views.size(); }
  bool has(std::string_view layout) const;
  bool wants(std::string_view truth_kind) const;
  bool hasExactEf(std::string_view layout) const;
  bool wantsTracks() const;                      // as truth, or for a layout
  bool gives(std::string_view parameter) const;  // for all hearts
  // Splits by the order of hearts in their block: train, then validation, then test. Hearts are
  // independent draws, and some loaders split by number. All draws of one user's scene are in one
  // split.
  Split splitOf(int heart) const;
  // The scene of a heart, cyclically. Precondition: the spec has scenes.
  const UserScene& sceneOf(int heart) const;
  // All drawn parameters of a population's heart.
  std::vector<Parameter> parametersOf(const Population& population) const;
};

// MyoTracker's loader skips loops with fewer frames.
inline constexpr int kLeastTrackedFrames = 30;

// Names of the layouts.
std::vector<std::string> layoutNames();

// Throws SceneError if a parameter can take a value that a scene or a layout rejects.
void checkSpec(const Spec& spec);

// Throws SceneError `file:line: key: fault, accepted values`.
Spec readSpec(const std::filesystem::path& file);
Spec parseSpec(std::string_view text, const std::filesystem::path& file);

}  // namespace echocine::dataset
