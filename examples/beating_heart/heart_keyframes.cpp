#include "examples/beating_heart/heart_keyframes.h"

#include <charconv>
#include <cmath>

#include "examples/beating_heart/heart_shape.h"

namespace echocine::beating_heart {
namespace {

// Four decimals of a centimetre, a micrometre, in any locale. Never "-0.0000".
void appendCoordinate(std::string& text, double value_cm) {
  const double rounded_cm = std::round(value_cm * 1e4) / 1e4 + 0.0;
  char digits[32];
  const auto end =
      std::to_chars(digits, digits + sizeof digits, rounded_cm, std::chars_format::fixed, 4);
  text += ' ';
  text.append(digits, end.ptr);
}

std::string objText(const std::vector<Vec3d>& points_cm, const std::vector<Face>& faces) {
  std::string text;
  for (const Vec3d point : points_cm) {
    text += 'v';
    for (const double value_cm : {point.x, point.y, point.z}) appendCoordinate(text, value_cm);
    text += '\n';
  }
  for (const Face& face : faces) {
    text += 'f';
    for (const auto vertex : face) text += ' ' + std::to_string(vertex + 1);  // OBJ counts from 1
    text += '\n';
  }
  return text;
}

std::string fileName(const std::string& part, int keyframe) {
  const std::string number = std::to_string(keyframe);
  return part + (keyframe < 10 ? "_0" : "_") + number + ".obj";
}

}  // namespace

std::vector<KeyframeFile> heartKeyframes() {
  std::vector<KeyframeFile> files;
  for (int keyframe = 0; keyframe < kKeyframes; ++keyframe)
    for (const Part& part : heartAt(double(keyframe) / kKeyframes)) {
      const auto control_cm = loopControlPoints(part.points_cm, part.faces);
      files.push_back({fileName(part.name, keyframe), objText(control_cm, part.faces)});
    }
  return files;
}

}  // namespace echocine::beating_heart
