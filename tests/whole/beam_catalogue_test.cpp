// The catalogue of recordings beside an archive's stores.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "archive/echoxflow.h"
#include "core/error.h"
#include "support/beam_loops.h"
#include "support/run_files.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

// A catalogue that another program wrote may have other types. Its rows stay; a damaged one is
// refused before the recording is replaced.
TEST(BeamCatalogue, ADamagedCatalogueLeavesTheRecording) {
  const BeamLoop loop = smallBeamLoop();
  const TempFolder folder;
  const fs::path root = folder / "root", zarr = root / "exam/loop.zarr";
  writeEchoXFlow(loop, root, "exam", "loop");
  EXPECT_THROW(writeEchoXFlow(loop, root, "", "loop"), SceneError);
  EXPECT_THROW(writeEchoXFlow(loop, root, "exam", ""), SceneError);
  const std::string chunk = bytesOf(zarr / ".zattrs");
  folder.write("root/croissant.json", "[]");
  EXPECT_THROW(writeEchoXFlow(smallBeamLoop(9), root, "exam", "loop"), SceneError);
  EXPECT_EQ(bytesOf(zarr / ".zattrs"), chunk);
  folder.write(
      "root/croissant.json",
      R"({"recordSet": [{"@id": 3}, {"@id": "recordings", "data": [{"recordings/zarr_path": 7}]}]})");
  writeEchoXFlow(loop, root, "exam", "loop");
  const auto catalogue = nlohmann::json::parse(bytesOf(root / "croissant.json"));
  EXPECT_EQ(catalogue.at("recordSet").at(1).at("data").size(), 2u);
}

}  // namespace
}  // namespace echocine
