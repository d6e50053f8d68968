#pragma once
// Fills a table of knobs, with a reason for each omitted one.

#include "study/knobs.h"

namespace echocine {

struct KnobBuilder {
  // A knob of numbers, rough to accurate; equal values are listed once. of_preset: index into
  // numbers.
  void addNumbers(const char* name, const char* key, const char* meaning,
                  const std::vector<int>& numbers,
                  const std::array<std::size_t, kPresets>& of_preset,
                  const std::function<void(Scene&, int)>& apply);

  // A knob with a single value is omitted.
  void add(Knob knob);
  void leaveOut(const std::string& knob, const std::string& reason);

  KnobTable table;
};

// Knobs of the surfaces: subdivision, normals, keyframes, interpolation. triangles: of all
// structures in the scene as written.
void addMotionKnobs(const Scene& scene, std::size_t triangles, KnobBuilder& table);

// Knobs of modelling decisions that the paper leaves open: effects and time gain.
void addModelKnobs(const Scene& scene, KnobBuilder& table);

}  // namespace echocine
