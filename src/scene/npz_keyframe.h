#pragma once
// Keyframes in one NumPy file: `lv.npz[3]` names points[3] of lv.npz, as in Python.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

namespace echocine {

struct NpzKeyframe {
  std::filesystem::path file;
  std::optional<std::size_t> keyframe;  // none: the file's only one
};

// The parts of a keyframe's name; none if it names no .npz file.
std::optional<NpzKeyframe> npzKeyframeOf(const std::filesystem::path& name);

// The names of all keyframes of a .npz file. Only the header of its points is read. Throws
// SceneError that starts with the file's name.
std::vector<std::filesystem::path> npzKeyframeNames(const std::filesystem::path& file);

}  // namespace echocine
