#pragma once
// Fills a table of knobs, and says of each that is left out why.

#include "study/knobs.h"

namespace echocine {

struct KnobBuilder {
  // A knob of numbers, rough to accurate; equal ones are listed once. of_preset: index into
  // numbers.
  void addNumbers(const char* name, const char* key, const char* meaning,
                  const std::vector<int>& numbers,
                  const std::array<std::size_t, kPresets>& of_preset,
                  const std::function<void(Scene&, int)>& apply);

  // A knob of a single value is left out.
  void add(Knob knob);
  void leaveOut(const std::string& knob, const std::string& reason);

  KnobTable table;
};

// How the surfaces are made: subdivision, normals, keyframes, interpolation. triangles: of all
// structures as the scene is written.
void addMotionKnobs(const Scene& scene, std::size_t triangles, KnobBuilder& table);

// What the model decides where the paper leaves it open: effects and time gain.
void addModelKnobs(const Scene& scene, KnobBuilder& table);

}  // namespace echocine
