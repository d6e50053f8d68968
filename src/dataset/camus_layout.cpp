// CAMUS's NIfTI release: database_nifti/patientNNNN and database_split.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dataset/clean_labels.h"
#include "dataset/layout.h"
#include "dataset/nifti.h"
#include "dataset/record.h"
#include "truth/simpson.h"

namespace echocine::dataset {

namespace {

const char* viewWord(const LoopSample& loop) {
  return loop.view == View::a2c ? "2CH" : "4CH";
}

// Pixels of frames first to last, pictures or labels.
std::vector<std::uint8_t> pixelsOf(const LoopSample& loop, int first, int last, bool labels) {
  std::vector<std::uint8_t> all;
  for (int f = first; f <= last; ++f) {
    const LoopFrame& frame = loop.frames[static_cast<std::size_t>(f)];
    const std::vector<std::uint8_t> one =
        labels ? wholeCavity(frame.labels, loop.width(), loop.height()) : frame.image.pixels;
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}

// Elliptical discs of the two views' widths along the longer of their axes, mL.
double biplaneOfViews(const Heart& heart, bool end_systole) {
  std::vector<double> widths[2];
  double length_m = 0;
  for (std::size_t v = 0; v < 2; ++v) {
    const LoopSample& loop = heart.loops[v];
    const int at = end_systole ? loop.instants.es : loop.instants.ed;
    const LoopFrame& frame = loop.frames[static_cast<std::size_t>(at)];
    if (frame.disc_widths_m.empty()) return 0;
    widths[v] = frame.disc_widths_m;
    length_m = std::max(length_m, frame.traced_length_m);
  }
  return 1e6 * discVolume(length_m, widths[0], widths[1]);
}

std::string word(const Json& drawn, const char* key, const std::string& fallback) {
  return drawn.contains(key) ? drawn.at(key).get<std::string>() : fallback;
}

// Exactly eight lines: the loaders split each at ": ". Numbers of frames are from 1 within the half
// sequence.
std::string infoText(const LoopSample& loop, const Json& entry, double ef_percent) {
  const Json& drawn = entry["drawn"];
  std::string quality = word(drawn, "scene.signal.quality", "good");
  quality[0] = static_cast<char>(quality[0] - 'a' + 'A');
  const int frames = loop.instants.es - loop.instants.ed + 1;
  return fmt::format(
      "ED: 1\nES: {0}\nNbFrame: {0}\nSex: {1}\nAge: {2}\nImageQuality: {3}\nEF: {4:.0f}\n"
      "FrameRate: {5:.1f}\n",
      frames, word(drawn, "subject.sex", "F"), std::lround(drawn.value("subject.age", 60.0)),
      quality, ef_percent, loop.scene.acquisition.frame_rate_hz);
}

void writeView(const Heart& heart, const LoopSample& loop, const Json& entry, double ef_percent,
               Sink& sink) {
  const std::string start = fmt::format("camus/database_nifti/patient{0:04}/patient{0:04}_{1}_",
                                        heart.number, viewWord(loop));
  const double mm = 1e3 * loop.geometry.metres_per_pixel;
  const auto write = [&](const char* what, int first, int last, int frames) {
    const NiftiShape shape{
        loop.width(), loop.height(), frames, mm, mm, 1 / loop.scene.acquisition.frame_rate_hz};
    sink.write(fmt::format("{}{}.nii.gz", start, what),
               niftiBytes(shape, pixelsOf(loop, first, last, false)));
    sink.write(fmt::format("{}{}_gt.nii.gz", start, what),
               niftiBytes(shape, pixelsOf(loop, first, last, true)));
  };
  const Instants& at = loop.instants;
  write("ED", at.ed, at.ed, 0);
  write("ES", at.es, at.es, 0);
  write("half_sequence", at.ed, at.es, at.es - at.ed + 1);
  sink.write(
      fmt::format("camus/database_nifti/patient{:04}/Info_{}.cfg", heart.number, viewWord(loop)),
      infoText(loop, entry, ef_percent));
}

void writeCamus(const Spec& spec, const Heart& heart, Sink& sink, Json& record) {
  const double ed_ml = biplaneOfViews(heart, false), es_ml = biplaneOfViews(heart, true);
  const bool traced = ed_ml > 0 && es_ml > 0;  // else a plane misses the long axis
  const double of_views = ejectedPercent(ed_ml, es_ml);
  const auto or_null = [&](double value) { return traced ? Json(value) : Json(); };
  for (std::size_t v = 0; v < heart.loops.size(); ++v) {
    Json& entry = record["loops"][v];
    entry["camus"] = {{"edv_views_ml", or_null(ed_ml)},
                      {"esv_views_ml", or_null(es_ml)},
                      {"ef_views_percent", or_null(of_views)}};
    const bool exact = spec.hasExactEf("camus") || !traced;
    writeView(heart, heart.loops[v], entry, exact ? entry["ef_percent"].get<double>() : of_views,
              sink);
  }
}

void mergeCamus(const Spec&, std::span<const Json> records, Sink& sink) {
  constexpr std::pair<const char*, const char*> kLists[] = {
      {"train", "training"}, {"val", "validation"}, {"test", "testing"}};
  for (const auto& [split, file] : kLists) {
    std::string list;
    for (const Json& record : records)
      if (record.at("split") == split)
        list += fmt::format("patient{:04}\n", record.at("heart").get<int>());
    sink.write(fmt::format("camus/database_split/subgroup_{}.txt", file), list);
  }
}

}  // namespace

const Layout kCamus{"camus", writeCamus, mergeCamus};

}  // namespace echocine::dataset
