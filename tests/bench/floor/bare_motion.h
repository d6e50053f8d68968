#pragma once
// The floors of the motion stage: the blend in one pass over memory, and the enclosed volumes with
// a corner per register.

#include <vector>

#include "bench/bench_scene.h"

namespace echocine::bench {

class BareMotion {
 public:
  explicit BareMotion(const BenchScene& scene) : scene_(scene) {
    for (const auto& keyframes : scene.keyframes_m)
      out_.emplace_back(keyframes.front().size() + 1);  // one more, for reading 16 bytes at a time
  }

  // Four keyframes, as Catmull-Rom takes them.
  void blend(std::size_t i) {
    const double phase = BenchScene::phase(i);
    for (std::size_t s = 0; s < out_.size(); ++s) {
      scene_.motion[s].weights.termsAt(phase, terms_);
      const float* from[4];
      float weight[4];
      for (std::size_t k = 0; k < 4; ++k) {
        from[k] = &scene_.keyframes_m[s][terms_[k].row].front().x;
        weight[k] = static_cast<float>(terms_[k].weight);
      }
      float* to = &out_[s].front().x;
      const std::size_t count = 3 * (out_[s].size() - 1);
      for (std::size_t v = 0; v < count; ++v)
        to[v] = weight[0] * from[0][v] + weight[1] * from[1][v] + weight[2] * from[2][v] +
                weight[3] * from[3][v];
    }
  }

  // In single precision, about the origin.
  double volumes() {
    double sum = 0;
    for (std::size_t s = 0; s < out_.size(); ++s) {
      const float* p = &out_[s].front().x;
      Four six{};
      const auto corner = [&](std::uint32_t v) {
        Four q;
        __builtin_memcpy(&q, p + 3 * v, sizeof q);
        return q;
      };
      for (const Triangle& t : scene_.topology[s].triangles) {
        const Four a = corner(t[0]), b = corner(t[1]), c = corner(t[2]);
        six += a * (turned(b) * turned(turned(c)) - turned(turned(b)) * turned(c));
      }
      sum += static_cast<double>(six[0] + six[1] + six[2]);
    }
    return sum;
  }

 private:
  using Four = float __attribute__((vector_size(16)));
  static Four turned(Four p) { return Four{p[1], p[2], p[0], p[3]}; }

  const BenchScene& scene_;
  std::vector<std::vector<Vec3f>> out_;
  std::vector<KeyframeWeights::Term> terms_;
};

}  // namespace echocine::bench
