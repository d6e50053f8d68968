#pragma once
// A small beating ball on disk, for runs of the whole program.

#include "support/scene_text.h"
#include "support/temp_folder.h"

namespace echocine::support {

// A ball of blood in muscle that shrinks and grows, with a membrane in it; 8 keyframes, `frames`
// frames.
inline SceneText ballScene(int frames) {
  SceneText text;
  text.probe["lines"] = "32";
  text.acquisition["frame_rate_hz"] = std::to_string(frames);
  text.background = "soft_tissue";
  text.addStructure("wall", "myocardium", "\"wall_*.obj\"", 1);
  text.addStructure("cavity", "blood", "\"cavity_*.obj\"", 2);
  text.structures +=
      "[[structure]]\nname = \"leaflet\"\nmedium = \"valve\"\nmembrane = true\nkeyframes = "
      "\"leaflet.obj\"\n";
  return text;
}

// A wide beam and a long pulse: the reference of such a scene has few lines and samples.
inline void makeCoarse(SceneText& text) {
  text.probe["aperture_mm"] = "6";
  text.signal["pulse_cycles"] = "8";
}

inline void writeBallMeshes(const TempFolder& folder) {
  for (int i = 0; i < 8; ++i) {
    const double squeeze = 1 + 0.15 * std::cos(2 * std::numbers::pi * i / 8);
    const std::string end = "_" + std::to_string(i) + ".obj";
    writeObj(icosphere(2, 3.5).moved({0.3, 0.2, 6}), folder / ("wall" + end));
    writeObj(icosphere(2, 2.5 * squeeze).moved({0.3, 0.2, 6}), folder / ("cavity" + end));
  }
  writeObj(sheet(4, 0.8, 6), folder / "leaflet.obj");
}

inline std::filesystem::path writeBall(const TempFolder& folder, const SceneText& text) {
  writeBallMeshes(folder);
  return folder.write("scene.toml", text.text());
}

}  // namespace echocine::support
