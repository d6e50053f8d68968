// The digest at the end of a manifest.

#include "core/seal.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace echocine {
namespace {

TEST(Seal, AnyFlippedBitAndAnyCutIsFound) {
  const nlohmann::ordered_json object{{"scene", {{"lines", 256}}}, {"frames", {1, 2}}};
  const std::string text = sealed(object.dump(1));
  ASSERT_TRUE(isSealed(text));
  EXPECT_EQ(nlohmann::json::parse(text).at("frames").size(), 2u);
  EXPECT_EQ(nlohmann::json::parse(text).at("manifest_sha256").get<std::string>().size(), 64u);
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string flipped = text;
      flipped[i] = static_cast<char>(flipped[i] ^ (1 << bit));
      EXPECT_FALSE(isSealed(flipped)) << i << ' ' << bit;
    }
    EXPECT_FALSE(isSealed(text.substr(0, i))) << i;
  }
  EXPECT_FALSE(isSealed(text + "\n"));
}

}  // namespace
}  // namespace echocine
