// EchoNet-Dynamic: FileList.csv, VolumeTracings.csv and Videos/ID.avi, 112 x 112.

#include <fmt/format.h>

#include "dataset/layout.h"
#include "dataset/shrink.h"

namespace echocine::dataset {

namespace {

constexpr int kSide = 112;

// Its rows as [x1, y1, x2, y2]: the long axis, then the chords.
Json rowsOf(const Tracing& tracing, const Square& square) {
  Json rows = Json::array();
  const auto add = [&](PixelPoint from, PixelPoint to) {
    const PixelPoint a = inShrunk(from, square, kSide), b = inShrunk(to, square, kSide);
    rows.push_back({a.x, a.y, b.x, b.y});
  };
  add(tracing.apex, tracing.base);
  for (const auto& [from, to] : tracing.chords) add(from, to);
  return rows;
}

void writeEchonet(const Spec&, const Heart& heart, Sink& sink, Json& record) {
  for (std::size_t v = 0; v < heart.loops.size(); ++v) {
    const LoopSample& loop = heart.loops[v];
    const Square square = sectorSquare(loop.frames.front().image);
    std::vector<GreyImage> small;
    for (const LoopFrame& frame : loop.frames) small.push_back(shrunk(frame.image, square, kSide));
    std::vector<const GreyImage*> images;
    for (const GreyImage& image : small) images.push_back(&image);
    sink.writeCine(fmt::format("echonet/Videos/{}.avi", loop.id), images,
                   loop.scene.acquisition.frame_rate_hz);
    // The part of the picture that the video shows, in pixels of the picture; its side is kSide.
    const Json crop{{"x_px", square.x}, {"y_px", square.y}, {"side_px", square.side}};
    record["loops"][v]["echonet"] = {{"crop", crop},
                                     {"ed", rowsOf(loop.ed_tracing, square)},
                                     {"es", rowsOf(loop.es_tracing, square)}};
  }
}

// The loader takes the frame whose rows come first for end-systole, and a mask from the first point
// of every chord, then the second ones backwards.
void addTracing(const Json& loop, const char* instant, std::string& text) {
  for (const Json& row : loop.at("echonet").at(instant))
    text +=
        fmt::format("{}.avi,{:.3f},{:.3f},{:.3f},{:.3f},{}\n", loop.at("id").get<std::string>(),
                    row.at(0).get<double>(), row.at(1).get<double>(), row.at(2).get<double>(),
                    row.at(3).get<double>(), loop.at(fmt::format("{}_frame", instant)).get<int>());
}

// EF,ESV,EDV of a loop, from the keys that start with ef_, esv_ and edv_; empty cells where a plane
// of a user's scene shows no long axis.
std::string volumesOf(const Json& loop, const char* ef, const char* esv, const char* edv) {
  if (loop.at(ef).is_null()) return ",,";
  return fmt::format("{:.4f},{:.4f},{:.4f}", loop.at(ef).get<double>(), loop.at(esv).get<double>(),
                     loop.at(edv).get<double>());
}

const char* splitWord(const std::string& split) {
  return split == "train" ? "TRAIN" : split == "val" ? "VAL" : "TEST";
}

// The loader takes columns by name, so those of both kinds of volumes follow its nine.
void mergeEchonet(const Spec& spec, std::span<const Json> records, Sink& sink) {
  std::string list =
      "FileName,EF,ESV,EDV,FrameHeight,FrameWidth,FPS,NumberOfFrames,Split,"
      "EFTracing,ESVTracing,EDVTracing,EFExact,ESVExact,EDVExact\n";
  std::string tracings = "FileName,X1,Y1,X2,Y2,Frame\n";
  for (const Json& record : records)
    for (const Json& loop : record.at("loops")) {
      const std::string exact = volumesOf(loop, "ef_percent", "esv_ml", "edv_ml"),
                        traced = volumesOf(loop, "ef_single_plane_percent", "esv_single_plane_ml",
                                           "edv_single_plane_ml");
      list +=
          fmt::format("{},{},{},{},{:g},{},{},{},{}\n", loop.at("id").get<std::string>(),
                      spec.hasExactEf("echonet") || traced == ",," ? exact : traced, kSide, kSide,
                      loop.at("frame_rate_hz").get<double>(), loop.at("frames").get<int>(),
                      splitWord(record.at("split").get<std::string>()), traced, exact);
      addTracing(loop, "es", tracings);
      addTracing(loop, "ed", tracings);
    }
  sink.write("echonet/FileList.csv", list);
  sink.write("echonet/VolumeTracings.csv", tracings);
}

}  // namespace

const Layout kEchonet{"echonet", writeEchonet, mergeEchonet};

}  // namespace echocine::dataset
