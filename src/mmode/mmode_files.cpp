#include "mmode/mmode_files.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <system_error>

#include "core/error.h"
#include "core/file.h"
#include "core/folder_lock.h"
#include "core/hash.h"
#include "core/output_check.h"
#include "core/parallel.h"
#include "core/seal.h"
#include "core/stop.h"
#include "core/units.h"
#include "mmode/mmode_picture.h"
#include "motion/surfaces/probe_placement.h"
#include "output/plane_exr.h"
#include "output/polar_plane.h"
#include "output/scene_sha256.h"
#include "scene/names.h"
#include "video/cine_writer.h"

namespace echocine {

namespace {

using Json = nlohmann::ordered_json;

std::span<const std::byte> bytesOf(const std::string& text) {
  return std::as_bytes(std::span(text));
}

// Rows of equal depth from the columns of an M-mode.
std::vector<float> rowsOf(std::span<const float> plane, const MMode& mode) {
  return rowsFromLines(plane, static_cast<std::size_t>(mode.columns),
                       static_cast<std::size_t>(mode.samples));
}

std::vector<std::byte> exrOf(const MMode& mode, const Scene& scene, double rate_hz) {
  const std::vector<float> intensities = rowsOf(mode.intensities, mode);
  const std::vector<float> greys = rowsOf(mode.greys, mode);
  PlaneExr exr;
  exr.width = mode.columns;
  exr.height = mode.samples;
  exr.channels = {{"display", greys}, {"intensity", intensities}};
  exr.numbers = {{"echocine:rate_hz", rate_hz},
                 {"echocine:reference_intensity", mode.white},
                 {"echocine:min_depth_m", scene.probe.min_depth_m},
                 {"echocine:max_depth_m", scene.probe.max_depth_m},
                 {"echocine:place", mode.place}};
  exr.texts = {{"echocine:version", ECHOCINE_VERSION}};
  return encodePlaneExr(exr);
}

std::string quoted(const std::string& name) {
  if (name.find_first_of(",\"\r\n") == std::string::npos) return name;
  std::string out = "\"";
  for (const char c : name) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string bordersCsv(const MMode& mode, const Scene& scene) {
  std::string text = "time_s,phase,structure,depth_mm\n";
  for (const BorderCrossing& c : mode.borders) {
    const FrameTime& time = mode.times[static_cast<std::size_t>(c.column)];
    text += fmt::format("{},{},{},{:.5f}\n", time.time_s, time.phase,
                        quoted(scene.structures[index(c.surface)].name),
                        millimetresFromMetres(c.depth_m));
  }
  return text;
}

std::string ringCsv(const MMode& mode) {
  std::string text = "time_s,exact_mm,traced_mm\n";
  for (std::size_t t = 0; t < mode.times.size(); ++t)
    text += fmt::format("{},{:.5f},{}\n", mode.times[t].time_s,
                        millimetresFromMetres(mode.ring->exact_m[t]),
                        t < mode.ring->traced_m.size()
                            ? fmt::format("{:.5f}", millimetresFromMetres(mode.ring->traced_m[t]))
                            : "");
  return text;
}

Json jsonOf(const MMode& mode, const Simulator& simulator, const MModeRequest& request) {
  const Probe& probe = simulator.scene().probe;
  Json json;
  json["version"] = ECHOCINE_VERSION;
  json["scene_sha256"] = sceneSha256(simulator.scene(), simulator.motion());
  json["line"] = mode.line;
  if (probe.isFan())
    json["angle_deg"] = degreesFromRadians(mode.place);
  else
    json["offset_mm"] = millimetresFromMetres(mode.place);
  json["through"] = request.through ? Json(nameOf(*request.through)) : Json();
  json["rate_hz"] = request.rate_hz;
  json["columns"] = mode.columns;
  json["samples"] = mode.samples;
  json["min_depth_mm"] = millimetresFromMetres(probe.min_depth_m);
  json["max_depth_mm"] = millimetresFromMetres(probe.max_depth_m);
  json["reference_intensity"] = mode.white;
  if (mode.ring)
    json["ring"] = {{"start_depth_mm", millimetresFromMetres(mode.ring->start_depth_m)},
                    {"exact_on_line_mm", mode.ring->exact_mm},
                    {"traced_on_line_mm", mode.ring->traced_mm},
                    {"exact_in_space_mm", mode.ring->in_space_mm}};
  return json;
}

}  // namespace

MMode writeMMode(const Scene& given, const MModeOptions& options, const Monitor& monitor) {
  const Scene scene = mmodeScene(placed(given), options.request);
  MMode mode;
  withThreads(options.threads, [&] {
    const Simulator simulator(scene);
    passWarnings(simulator, monitor);
    checkMMode(simulator, options.request);
    makeFolder(options.folder);
    const FolderLock lock(options.folder);
    checkOutputFolder(options.folder,
                      {"mmode.json", "mmode.exr", "mmode.png", "borders.csv", "ring.csv"});
    mode = makeMMode(simulator, options.request, monitor);
    unstoppable([&] {
      std::error_code ignored;
      // A run without a ring as target replaces the other files, but writes no ring.csv.
      for (const char* name : {"mmode.json", "ring.csv"})
        std::filesystem::remove(options.folder / name, ignored);
      Json files;
      const auto write = [&](const char* name, std::span<const std::byte> bytes) {
        writeFileWhole(options.folder / name, bytes);
        files[name] = sha256Hex(bytes);
      };
      const double rate_hz = options.request.rate_hz;
      write("mmode.exr", exrOf(mode, scene, rate_hz));
      write("mmode.png", encodePng(mmodePicture(mode, scene, rate_hz, options.rows)));
      write("borders.csv", bytesOf(bordersCsv(mode, scene)));
      if (mode.ring) write("ring.csv", bytesOf(ringCsv(mode)));
      lock.checkStillThere();
      Json json = jsonOf(mode, simulator, options.request);
      json["files"] = files;
      writeFileWhole(options.folder / "mmode.json", bytesOf(sealed(json.dump(1))));
    });
  });
  return mode;
}

}  // namespace echocine
