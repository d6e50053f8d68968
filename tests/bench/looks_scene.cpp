#include "looks_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "core/file.h"
#include "scene/key_reader.h"
#include "scene/names.h"
#include "scene/signal_reader.h"
#include "signal/signal_chain.h"
#include "truth/frame_truth.h"

namespace echocine::bench {

heart::Parameters parametersOf(int number) {
  const auto between = [&](double low, double high, double step) {
    const double at = 0.5 + step * number;
    return low + (high - low) * (at - std::floor(at));
  };
  return heart::parametersFrom({{"edv", between(90, 180, 0.7549)},
                                {"ef", between(0.35, 0.68, 0.5698)},
                                {"wall-thickness", between(8, 12, 0.4302)},
                                {"hr", between(55, 90, 0.3247)}});
}

void savePgm(const std::string& path, const GreyImage& image) {
  std::ofstream out(path, std::ios::binary);
  out << "P5\n" << image.width << " " << image.height << "\n255\n";
  out.write(reinterpret_cast<const char*>(image.pixels.data()),
            static_cast<std::streamsize>(image.pixels.size()));
}

std::vector<std::uint16_t> idsOf(const Simulator& simulator, double phase) {
  Scene scene = simulator.scene();
  scene.truth.labels = true;
  const PictureGeometry g = simulator.chain().geometry();
  const PictureGrid grid{scene.output.width, scene.output.height, g.origin_x_px, g.origin_y_px,
                         g.metres_per_pixel};
  const TruthMaker truth(scene, simulator.motion(), grid, phase);
  return truth.at({phase, phase, phase, 1}).picture_ids;
}

void takeTables(const LookHearts& options, Scene& scene) {
  const SignalSettings before = scene.signal;
  scene.signal = {};
  scene.trabeculae = {};
  scene.leaflets = {};
  scene.speckle = {};
  scene.artefacts = {};
  scene.signal.look = options.look;
  scene.signal.quality = options.quality;
  std::string text = options.with.empty() ? "" : readTextFile(options.with, std::size_t{1} << 20);
  if (text.find("[signal]") == std::string::npos) text += "\n[signal]\n";
  text.insert(
      text.find("[signal]") + 8,
      fmt::format("\nlook = \"{}\"\n", nameOf(options.look)) +
          (isScanner(options.look) ? fmt::format("quality = \"{}\"\n", nameOf(options.quality))
                                   : ""));
  TomlTable root = TomlTable::parse(text, options.with);
  takeLook(root.table("signal"), scene);
  readSignal(root.table("signal"), scene);
  for (const char* name : {"trabeculae", "leaflets", "speckle", "artefacts"}) {
    TomlTable table = root.table(name);
    readKeys(table, name, {&scene});
  }
  if (!scene.signal.reference_intensity)
    scene.signal.reference_intensity = before.reference_intensity;
}

void seedScene(int number, Scene& scene) {
  scene.speckle.seed = number + 1;
  scene.artefacts.noise_seed = scene.artefacts.clutter_seed = number + 1;
  scene.artefacts.shading_seed = number + 1;
  scene.speckle.heterogeneity_seed = scene.trabeculae.seed = number + 1;
}

}  // namespace echocine::bench
