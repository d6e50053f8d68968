// nnU-Net v2: raw data of one case a frame, and the folds that keep a heart's frames together.

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "dataset/layout.h"
#include "dataset/record.h"
#include "dataset/structure_labels.h"
#include "video/cine_writer.h"

namespace echocine::dataset {

namespace {

constexpr const char* kFolder = "nnunet/nnUNet_raw/Dataset501_EchoCine";
constexpr int kFolds = 5;  // of its cross-validation; fewer if there are fewer hearts

std::string caseName(const std::string& id, int frame) {
  return fmt::format("{}_f{:03}", id, frame);
}

// End-diastole and end-systole, as annotators do; training cases are the hearts of "train" and
// "val".
void writeNnunet(const Spec& spec, const Heart& heart, Sink& sink, Json& record) {
  const char* const part = heart.split == Split::test ? "Ts" : "Tr";
  for (std::size_t v = 0; v < heart.loops.size(); ++v) {
    const LoopSample& loop = heart.loops[v];
    Json cases = Json::array();
    for (const int number : {loop.instants.ed, loop.instants.es}) {
      const LoopFrame& frame = loop.frames[static_cast<std::size_t>(number)];
      const std::string name = caseName(loop.id, number);
      sink.write(fmt::format("{}/images{}/{}_0000.png", kFolder, part, name),
                 encodePng(frame.image));
      sink.write(fmt::format("{}/labels{}/{}.png", kFolder, part, name),
                 encodePng(GreyImage{loop.width(), loop.height(),
                                     spec.nnunet_all ? frame.structure_labels : frame.labels}));
      cases.push_back(name);
    }
    record["loops"][v]["nnunet"] = cases;
  }
}

// Names of the labels by number.
Json labelsJson(bool all) {
  if (!all) return {{"background", 0}, {"lv_cavity", 1}, {"lv_myocardium", 2}, {"la_cavity", 3}};
  Json labels = Json::object();
  for (const char* name : structureLabelNames()) labels[name] = labels.size();
  return labels;
}

void mergeNnunet(const Spec& spec, std::span<const Json> records, Sink& sink) {
  std::vector<std::pair<int, std::string>> cases;  // fold, name
  std::map<std::string, int> fold_of;              // by group of hearts
  for (const Json& record : records) {
    if (record.at("split") == "test") continue;
    const int next = static_cast<int>(fold_of.size()) % kFolds;
    const int fold = fold_of.emplace(groupOf(record), next).first->second;
    for (const Json& loop : record.at("loops"))
      for (const Json& name : loop.at("nnunet")) cases.emplace_back(fold, name.get<std::string>());
  }
  const Json dataset{{"channel_names", {{"0", "US"}}},
                     {"labels", labelsJson(spec.nnunet_all)},
                     {"numTraining", cases.size()},
                     {"file_ending", ".png"}};
  sink.write(fmt::format("{}/dataset.json", kFolder), dataset.dump(1) + "\n");
  // A fold without validation cases ends nnU-Net, and a heart in both parts would be a leak. With
  // one heart or one scene there are no folds.
  const int groups = static_cast<int>(fold_of.size());
  if (groups < 2) return;
  Json folds = Json::array();
  for (int fold = 0; fold < std::min(kFolds, groups); ++fold) {
    Json one{{"train", Json::array()}, {"val", Json::array()}};
    for (const auto& [of, name] : cases) one[of == fold ? "val" : "train"].push_back(name);
    folds.push_back(std::move(one));
  }
  sink.write("nnunet/nnUNet_preprocessed/Dataset501_EchoCine/splits_final.json",
             folds.dump(1) + "\n");
}

}  // namespace

const Layout kNnunet{"nnunet", writeNnunet, mergeNnunet};

}  // namespace echocine::dataset
