#pragma once
// Effects of the picture alone: truth stays that of the meshes.

#include <gtest/gtest.h>

#include <utility>

#include "frame/simulator.h"
#include "motion/heart/heart_scene.h"

namespace echocine::support {

// Precondition: equal meshes; the scenes differ in an effect that shows.
inline void expectPictureOnly(Scene plain, Scene changed) {
  for (Scene* scene : {&plain, &changed}) {
    TruthSettings& truth = scene->truth;
    truth.labels = truth.contours = truth.tracks = truth.function = true;
    scene->signal.reference_intensity = 4e-4;
    scene->probe.lines = 96;
    scene->probe.samples = 384;
  }
  const Simulator one(std::move(plain)), other(std::move(changed));
  for (const double time_s : {0.0, 0.31}) {
    const Frame a = one.frame(time_s), b = other.frame(time_s);
    EXPECT_EQ(a.volumes_ml, b.volumes_ml);
    EXPECT_EQ(a.truth->labels, b.truth->labels);
    EXPECT_EQ(a.truth->tracks_m, b.truth->tracks_m);
    ASSERT_EQ(a.truth->contours.size(), b.truth->contours.size());
    EXPECT_NE(a.image.pixels, b.image.pixels);
  }
}

// A part of the valves that all looks but `paper` show.
inline void expectOfLooksButPaper(double LeafletSettings::*size_m) {
  for (const Look look : {Look::paper, Look::clean, Look::scanner}) {
    const Scene scene = heart::heartScene(heart::parametersFrom({}), heart::View::a4c, 4, look);
    EXPECT_EQ(scene.leaflets.*size_m > 0, look != Look::paper);
  }
}

}  // namespace echocine::support
