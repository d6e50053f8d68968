#pragma once
// A bench scene as files, for runs of the whole program.

#include <fmt/format.h>

#include <fstream>

#include "bench/bench_scene.h"
#include "support/temp_folder.h"

namespace echocine::bench {

class LoopOnDisk {
 public:
  static constexpr int kFrames = 72;

  LoopOnDisk(const BenchScene& scene, bool exr) {
    for (std::size_t s = 0; s < scene.topology.size(); ++s)
      for (std::size_t k = 0; k < scene.keyframes_m[s].size(); ++k)
        writePly(fmt::format("ball{}_{}.ply", s, k), scene.keyframes_m[s][k],
                 scene.topology[s].triangles);
    writeScene(scene.scene, exr);
  }
  std::filesystem::path sceneFile() const { return folder_ / "scene.toml"; }
  const support::TempFolder& folder() const { return folder_; }

 private:
  void writePly(const std::string& name, const std::vector<Vec3f>& points,
                const std::vector<Triangle>& triangles) const {
    std::ofstream out(folder_ / name, std::ios::binary);
    out << "ply\nformat binary_little_endian 1.0\nelement vertex " << points.size()
        << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
        << triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
    out.write(reinterpret_cast<const char*>(points.data()),
              static_cast<std::streamsize>(points.size() * sizeof(Vec3f)));
    for (const Triangle& t : triangles) {
      out.put(3);
      out.write(reinterpret_cast<const char*>(t.data()), sizeof t);
    }
  }

  // Meshes stand in the probe frame, in metres.
  void writeScene(const Scene& scene, bool exr) const {
    const Probe& p = scene.probe;
    std::ofstream out(sceneFile());
    out << "background = \"tissue\"\n[probe]\nkind = \"phased\"\napex = [0, 0, 0]\n"
           "axis = [0, 0, 1]\nlateral = [1, 0, 0]\nsector_deg = 75\nmin_depth_mm = 2\n"
           "depth_mm = 160\nfrequency_mhz = 2.5\n"
        << fmt::format("lines = {}\nsamples = {}\n", p.lines, p.samples)
        << fmt::format("[acquisition]\nheart_rate_bpm = 60\nframe_rate_hz = {}\n", kFrames)
        << "[motion]\nmesh_unit = \"m\"\n[effects]\nrefraction = \"off\"\n"
           "[signal]\nreference_intensity = 1e-6\n"
        << "[output]\nexr = " << (exr ? "true" : "false") << "\n";
    const struct {
      const char* name;
      double density, attenuation, per_cm_sr;
    } media[] = {
        {"tissue", 1050, 0.486, 1e-5}, {"blood", 1060, 0.139, 3e-8}, {"wall", 1097, 0.521, 1.6e-5}};
    for (const auto& m : media)
      out << fmt::format(
          "[media.{}]\ndensity_kg_m3 = {}\nsound_speed_m_s = 1584\nattenuation_db_cm_mhz = {}\n"
          "backscatter = {{ kind = \"fixed\", per_cm_sr = {} }}\n",
          m.name, m.density, m.attenuation, m.per_cm_sr);
    for (std::size_t s = 0; s < scene.structures.size(); ++s)
      out << fmt::format(
          "[[structure]]\nname = \"ball{0}\"\nmedium = \"{1}\"\npriority = {2}\n"
          "keyframes = \"ball{0}_*.ply\"\n",
          s, media[index(scene.structures[s].medium)].name, scene.structures[s].priority);
  }

  support::TempFolder folder_;
};

}  // namespace echocine::bench
