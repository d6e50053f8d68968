#include "scene/media_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/built_in_media.h"
#include "scene/key_reader.h"

namespace echocine {

namespace {

enum class Kind { none, fixed, blood, tissue };

double readLaw(TomlTable& table, std::string_view key) {
  return readNumber(table, sceneKey("media.backscatter", key));
}

BloodBackscatter readBlood(TomlTable& table, const MediumSpec& plasma) {
  BloodBackscatter blood;
  blood.hematocrit = readLaw(table, "hematocrit");
  blood.cell_radius_m = readLaw(table, "cell_radius_um");
  blood.cell_density_kg_m3 = readLaw(table, "cell_density_kg_m3");
  blood.cell_compressibility_per_pa = readLaw(table, "cell_compressibility_cm2_dyn");
  blood.plasma_density_kg_m3 = plasma.density_kg_m3;
  // A fluid's compressibility is G = 1 / (rho c^2).
  blood.plasma_compressibility_per_pa =
      1 / (plasma.density_kg_m3 * plasma.sound_speed_m_s * plasma.sound_speed_m_s);
  return blood;
}

// Keys of the kinds that this medium is not.
void noteOtherKinds(TomlTable& table, Kind kind) {
  if (kind != Kind::fixed) table.unused("per_cm_sr", "kind = \"fixed\"");
  if (kind != Kind::tissue)
    for (const char* key : {"velocity_variation", "correlation_length_um"})
      table.unused(key, "kind = \"tissue\"");
  if (kind != Kind::blood)
    for (const char* key : {"hematocrit", "cell_radius_um", "cell_density_kg_m3",
                            "cell_compressibility_cm2_dyn", "plasma"})
      table.unused(key, "kind = \"blood\"");
}

}  // namespace

MediaTable::MediaTable() {
  TomlTable table = TomlTable::parse(kBuiltInMedia, "data/media.toml");
  read(table);
  table.finish();
}

void MediaTable::read(TomlTable& file) {
  std::vector<std::pair<std::string, TomlTable>> tables = file.namedTables("media");
  // A blood medium refers to its plasma, which may stand anywhere in the file: two rounds.
  for (const bool with_blood : {false, true})
    for (auto& [name, table] : tables) {
      TomlTable backscatter = table.table("backscatter");
      if ((backscatter.text("kind", "") == "blood") == with_blood)
        specs_[name] = readMedium(name, table);
    }
}

MediumSpec MediaTable::readMedium(const std::string& name, TomlTable& table) const {
  MediumSpec spec;
  spec.name = name;
  readKeys(table, "media", {.medium = &spec});
  TomlTable backscatter = table.table("backscatter");
  if (!backscatter.has("kind"))
    backscatter.fail("kind", "is missing, accepted: \"none\" | \"fixed\" | \"blood\" | \"tissue\"");
  const std::vector<std::string_view> kinds{"none", "fixed", "blood", "tissue"};  // as in Kind
  const std::string word = backscatter.word("kind", "none", kinds);
  const auto kind = static_cast<Kind>(std::find(kinds.begin(), kinds.end(), word) - kinds.begin());
  noteOtherKinds(backscatter, kind);
  spec.blood = table.boolean("blood", kind == Kind::blood);
  switch (kind) {
    case Kind::none:
      break;
    case Kind::fixed:
      spec.backscatter = FixedBackscatter{readLaw(backscatter, "per_cm_sr")};
      break;
    case Kind::blood:
      spec.backscatter = readBlood(backscatter, named(backscatter, "plasma", "plasma"));
      break;
    case Kind::tissue:
      spec.backscatter = TissueBackscatter{readLaw(backscatter, "velocity_variation"),
                                           readLaw(backscatter, "correlation_length_um")};
      break;
  }
  backscatter.finish();
  table.finish();
  return spec;
}

const MediumSpec& MediaTable::named(TomlTable& table, std::string_view key,
                                    std::string fallback) const {
  const std::string name =
      fallback.empty() ? table.text(key) : table.text(key, std::move(fallback));
  const auto found = specs_.find(name);
  if (found != specs_.end()) return found->second;
  std::vector<std::string> names;
  std::string accepted;
  for (const auto& [known, spec] : specs_) {
    names.push_back(known);
    accepted += (accepted.empty() ? "" : ", ") + known;
  }
  const std::string nearest = nearestWord(name, names);
  table.fail(key, fmt::format("\"{}\" is not a known medium, accepted: {}{}", name, accepted,
                              nearest.empty() ? "" : " (nearest: " + nearest + ")"));
}

}  // namespace echocine
