#pragma once
// The parametric heart as files: keyframes, a scene, ground truth.

#include <filesystem>
#include <string>
#include <vector>

#include "motion/heart/heart_scene.h"
#include "motion/heart/recording.h"
#include "scene/scene.h"

namespace echocine {

struct HeartFiles {
  heart::Parameters parameters;
  heart::View view = heart::View::a4c;
  int keyframes = 24;
  heart::KeyframeSpacing spacing = heart::KeyframeSpacing::by_motion;
  Look look = Look::scanner;  // of the scene's pictures
  heart::MeshFormat format = heart::MeshFormat::obj;
  int threads = 0;
};

// A part's keyframe as OBJ text in mm, with subdivision tags.
std::string heartMesh(const heart::RecordedPart& part, std::size_t keyframe);

// All keyframes of a part as a NumPy file: points [K, V, 3] float64 in mm, rounded like the OBJ
// text; faces [F, 3] int32; corners [C] int32 and corner_sharpness [C] float32 if there are any.
std::vector<std::byte> heartNpz(const heart::RecordedPart& part);

// Writes NAME_00.obj ... or NAME.npz of every part, scene.toml and truth.json into `folder`, which
// must be absent or empty. The folder is written completely or not at all. Throws SceneError for
// impossible parameters, JobError if the folder cannot be written or the monitor requests a stop.
void writeHeart(const HeartFiles& wanted, const std::filesystem::path& folder,
                const Monitor& monitor = {});

}  // namespace echocine
