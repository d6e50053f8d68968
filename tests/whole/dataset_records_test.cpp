// What a dataset's folder says is believed only as far as it is proven: damaged, edited and forged
// records, planted links and pipes.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <map>

#include "dataset/record_check.h"
#include "support/run_files.h"
#include "support/run_program.h"

namespace echocine::dataset {
namespace {

using namespace support;
namespace fs = std::filesystem;

constexpr const char* kHead = R"(name = "tiny"
hearts = 2
views = ["a4c"]
layouts = ["native", "echonet"]
)";

class DatasetRecords : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    place = std::make_unique<TempFolder>();
    spec_file = place->write(
        "tiny.toml", kHead + bytesOf(fs::path(kSourceDir) / "tests/support/small_loops.toml"));
    ASSERT_EQ(make("whole").code, 0);
    whole = filesOf(*place / "whole");
    spec = readSpec(spec_file);
  }
  static void TearDownTestSuite() { place.reset(); }

  static Outcome make(const std::string& name, const std::string& options = "") {
    return runShell("timeout 120 %B dataset '" + spec_file.string() + "' -o '" +
                    (*place / name).string() + "' --threads 2 " + options + " >/dev/null");
  }

  // A copy of the whole dataset, which `damage` is done to; a merge then names `named`, and a run
  // makes the same bytes again.
  template <typename Damage>
  void expectFoundAndMended(const std::string& named, const Damage& damage) {
    const fs::path copy = *place / "copy";
    fs::remove_all(copy);
    fs::copy(*place / "whole", copy, fs::copy_options::recursive);
    damage(copy);
    const Outcome merged = make("copy", "--merge");
    EXPECT_EQ(merged.code, 1) << merged.err;
    EXPECT_NE(merged.err.find(named), std::string::npos) << merged.err;
    const Outcome made = make("copy");
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_NE(made.err.find("was rendered again: " + named), std::string::npos) << made.err;
    EXPECT_EQ(made.err.find("json.exception"), std::string::npos) << made.err;
    EXPECT_TRUE(filesOf(copy) == whole);
  }

  static fs::path recordOf(const fs::path& folder, int number) {
    return folder / "work/0000" / ("000000" + std::to_string(number) + ".json");
  }

  static Json sound() { return checkRecord(whole["work/0000/0000001.json"], spec, 0).record; }

  inline static std::unique_ptr<TempFolder> place;
  inline static fs::path spec_file;
  inline static std::map<std::string, std::string> whole;
  inline static Spec spec;
};

void replaceIn(const fs::path& file, const std::string& from, const std::string& to) {
  std::string text = bytesOf(file);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  std::ofstream(file, std::ios::binary) << text;
}

TEST_F(DatasetRecords, NoFlippedBitIsBelieved) {
  const std::string text = whole["work/0000/0000001.json"];
  ASSERT_TRUE(checkRecord(text, spec, 0).flaw.empty());
  for (std::size_t bit = 0; bit < 8 * text.size(); ++bit) {
    std::string flipped = text;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
    ASSERT_FALSE(checkRecord(flipped, spec, 0).flaw.empty()) << bit;
  }
  for (std::size_t size = 0; size < text.size(); ++size)
    ASSERT_FALSE(checkRecord(text.substr(0, size), spec, 0).flaw.empty()) << size;
  ASSERT_FALSE(checkRecord(text + " ", spec, 0).flaw.empty());
}

// A digest is no secret: whoever edits a record can seal it again. What is in it is checked then.
TEST_F(DatasetRecords, ForgedRecordsAreFoundByWhatTheySay) {
  const Json wrong[] = {nullptr, -1, 0.5, "../../x", Json::array(), Json::object(), true};
  const auto expectFlaw = [](const Json& forged, const std::string& what) {
    const CheckedRecord checked = checkRecord(sealedText(forged), spec, 0);
    EXPECT_FALSE(checked.flaw.empty()) << what;
    EXPECT_TRUE(checked.record.is_null()) << what;
  };
  ASSERT_EQ(checkRecord(sealedText(sound()), spec, 0).flaw, "");
  for (const char* key :
       {"spec", "heart", "population", "split", "attempt", "impossible", "loops", "files"}) {
    Json forged = sound();
    forged.erase(key);
    expectFlaw(forged, key);
    for (const Json& value : wrong) {
      if (value.type() == sound()[key].type() &&
          (value.is_number() || value.is_array() || value.is_object()))
        continue;
      forged[key] = value;
      expectFlaw(forged, key + value.dump());
    }
  }
  for (const char* key : {"id", "view", "frames", "ed_frame", "es_frame", "edv_ml", "drawn"}) {
    Json forged = sound();
    forged["loops"][0].erase(key);
    expectFlaw(forged, key);
    forged["loops"][0][key] = nullptr;
    expectFlaw(forged, key);
  }
  Json forged = sound();
  forged["loops"] = Json::array();
  expectFlaw(forged, "no loops");
  forged = sound();
  forged["loops"][0]["id"] = "../../etc/passwd";
  expectFlaw(forged, "id");
  forged = sound();
  forged["files"]["../outside"] = {{"bytes", 1u}, {"digest", ""}};
  expectFlaw(forged, "a file outside");
  forged = sound();
  forged["files"]["/etc/passwd"] = {{"bytes", 1u}, {"digest", ""}};
  expectFlaw(forged, "an absolute file");
  forged = sound();
  forged["heart"] = 2;
  expectFlaw(forged, "another heart's");
  std::string deep(1 << 20, '[');
  EXPECT_FALSE(checkRecord(deep, spec, 0).flaw.empty());
}

TEST_F(DatasetRecords, DamageIsFoundByAMergeAndMendedByARun) {
  expectFoundAndMended("work/0000/0000001.json: ", [](const fs::path& folder) {
    replaceIn(recordOf(folder, 1), "\"edv_ml\":", "\"edv_ml\":1");
  });
  expectFoundAndMended("work/0000/0000002.json: ", [](const fs::path& folder) {
    fs::copy_file(recordOf(folder, 1), recordOf(folder, 2), fs::copy_options::overwrite_existing);
  });
  expectFoundAndMended("native/ec000001_a4c/cine.avi: ", [](const fs::path& folder) {
    std::fstream file(folder / "native/ec000001_a4c/cine.avi",
                      std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(3000);
    const int byte = file.peek();
    file.put(static_cast<char>(byte ^ 16));
  });
}

// What another layout's entry lacks is not found by the record's own keys.
TEST_F(DatasetRecords, AnEntryThatALayoutMissesEndsInOneLine) {
  const fs::path copy = *place / "forged";
  fs::copy(*place / "whole", copy, fs::copy_options::recursive);
  for (const Json& value : {Json(nullptr), Json::object(), Json("x")}) {
    Json forged = sound();
    forged["loops"][0]["echonet"] = value;
    std::ofstream(recordOf(copy, 1), std::ios::binary) << sealedText(forged);
    const Outcome merged = make("forged", "--merge --quiet");
    EXPECT_EQ(merged.code, 1) << merged.err;
    EXPECT_NE(merged.err.find("another format than those of this program"), std::string::npos)
        << merged.err;
    EXPECT_EQ(std::count(merged.err.begin(), merged.err.end(), '\n'), 1) << merged.err;
  }
}

TEST_F(DatasetRecords, LinksAndPipesAreNeitherFollowedNorReplaced) {
  expectFoundAndMended("work/0000/0000001.json: ", [](const fs::path& folder) {
    fs::remove(recordOf(folder, 1));
    ASSERT_EQ(::mkfifo(recordOf(folder, 1).c_str(), 0600), 0);
  });
  expectFoundAndMended("native/ec000001_a4c/loop.json: ", [](const fs::path& folder) {
    fs::remove(folder / "native/ec000001_a4c/loop.json");
    ASSERT_EQ(::mkfifo((folder / "native/ec000001_a4c/loop.json").c_str(), 0600), 0);
  });
  expectFoundAndMended("native/ec000001_a4c/cine.avi: ", [](const fs::path& folder) {
    fs::rename(folder / "native/ec000001_a4c/cine.avi", folder / "../elsewhere.avi");
    fs::create_symlink(folder / "../elsewhere.avi", folder / "native/ec000001_a4c/cine.avi");
  });
  // A link to a folder would have the files written there.
  const fs::path copy = *place / "linked", elsewhere = *place / "elsewhere";
  fs::create_directories(copy / "work");
  fs::create_directories(elsewhere);
  fs::create_directory_symlink(elsewhere, copy / "native");
  const Outcome made = make("linked", "--quiet");
  EXPECT_EQ(made.code, 1);
  EXPECT_NE(made.err.find("native: is a link"), std::string::npos) << made.err;
  EXPECT_TRUE(fs::is_empty(elsewhere));
}

}  // namespace
}  // namespace echocine::dataset
