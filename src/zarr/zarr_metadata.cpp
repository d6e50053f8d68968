#include "zarr/zarr_metadata.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace echocine {

namespace {

using Metadata = nlohmann::json;  // of any order

constexpr std::size_t kMostShown = 40;

// Text of a file, as far as a message has room for it.
std::string shownValue(const Metadata& value) {
  std::string text = value.is_string()
                         ? value.get<std::string>()
                         : value.dump(-1, ' ', true, Metadata::error_handler_t::replace);
  std::string plain;
  for (const char c : text.substr(0, kMostShown)) plain += c >= ' ' && c <= '~' ? c : '?';
  return plain;
}

class LayoutReader {
 public:
  LayoutReader(const Metadata& json, const std::string& name) : json_(json), name_(name) {}

  ZarrLayout version2() const {
    ZarrLayout out;
    if (const Metadata& order = at(json_, "order"); order != "C" && order != "F")
      refuse("order", order);
    // With one axis, both orders are the same.
    if (at(json_, "order") == "F" && at(json_, "shape").size() > 1) refuse("order", "F");
    if (json_.contains("filters") && !json_["filters"].is_null() && !json_["filters"].empty())
      refuse("filters", idOf(json_["filters"]));
    out.shape = sides(json_, "shape");
    out.chunk = sides(json_, "chunks");
    out.type = typeOf(at(json_, "dtype"), {{"|u1", ZarrType::uint8},
                                           {"<u1", ZarrType::uint8},
                                           {"<f4", ZarrType::float32},
                                           {"<f8", ZarrType::float64}});
    out.fill = fillOf(json_);
    const Metadata& compressor = at(json_, "compressor");
    if (!compressor.is_null()) out.codecs.push_back(codecOf(compressor, "id"));
    out.separator = separatorOf(json_, "dimension_separator", '.');
    return out;
  }

  ZarrLayout version3() const {
    if (at(json_, "node_type") != "array") refuse("node_type", at(json_, "node_type"));
    ZarrLayout out;
    out.prefix = "c/";
    out.shape = sides(json_, "shape");
    const Metadata& grid = at(json_, "chunk_grid");
    if (nameOf(grid) != "regular") refuse("chunk_grid", grid);
    out.chunk = sides(at(grid, "configuration"), "chunk_shape");
    out.type = typeOf(at(json_, "data_type"), {{"uint8", ZarrType::uint8},
                                               {"float32", ZarrType::float32},
                                               {"float64", ZarrType::float64}});
    out.fill = fillOf(json_);
    readKeys(at(json_, "chunk_key_encoding"), out);
    const Metadata& codecs = at(json_, "codecs");
    if (!codecs.is_array() || codecs.empty() || codecs.size() > kMostZarrRank)
      refuse("codecs", codecs);
    if (nameOf(codecs.front()) != "bytes") refuse("codecs", nameOf(codecs.front()));
    const Metadata settings = settingsOf(codecs.front());
    if (settings.contains("endian") && settings["endian"] != "little")
      refuse("endian", settings["endian"]);
    for (std::size_t i = 1; i < codecs.size(); ++i)
      out.codecs.push_back(codecOf(codecs[i], "name"));
    return out;
  }

  // Sizes against the limits, without overflow.
  void check(const ZarrLayout& layout) const {
    if (layout.shape.size() != layout.chunk.size())
      fault(fmt::format("chunks: {} sides for {} axes", layout.chunk.size(), layout.shape.size()));
    product(layout.shape, kMostZarrValues, "shape", "values");
    product(layout.chunk, kMostZarrChunkBytes / layout.valueBytes(), "chunks", "values in a chunk");
    product(layout.grid(), kMostZarrChunks, "chunks", "chunks");
  }

 private:
  [[noreturn]] void fault(const std::string& what) const {
    throw SceneError(fmt::format("{}: {}", name_, what));
  }
  [[noreturn]] void refuse(const char* key, const Metadata& value) const {
    fault(fmt::format("{}: {} is not supported", key, shownValue(value)));
  }

  const Metadata& at(const Metadata& object, const char* key) const {
    if (!object.is_object() || !object.contains(key)) fault(fmt::format("{} is absent", key));
    return object[key];
  }

  std::string nameOf(const Metadata& value) const {
    if (value.is_string()) return value;  // a codec without settings
    const Metadata& name = at(value, "name");
    if (!name.is_string()) fault("a name is no text");
    return name;
  }

  // Those of a codec or an encoding; none if it is a name alone.
  Metadata settingsOf(const Metadata& value) const {
    if (!value.is_object() || !value.contains("configuration")) return Metadata::object();
    const Metadata& settings = value["configuration"];
    if (!settings.is_object()) refuse("configuration", settings);
    return settings;
  }

  static std::string idOf(const Metadata& filters) {
    const Metadata& first = filters.is_array() && !filters.empty() ? filters.front() : filters;
    return first.is_object() && first.contains("id") ? shownValue(first["id"]) : shownValue(first);
  }

  std::vector<std::size_t> sides(const Metadata& object, const char* key) const {
    const Metadata& list = at(object, key);
    if (!list.is_array() || list.empty() || list.size() > kMostZarrRank)
      fault(fmt::format("{}: {} is no list of 1 to {} numbers", key, shownValue(list),
                        kMostZarrRank));
    std::vector<std::size_t> out;
    for (const Metadata& side : list) {
      if (!side.is_number_unsigned() || side.get<std::uint64_t>() == 0)
        fault(fmt::format("{}: {} is no positive number", key, shownValue(side)));
      out.push_back(side.get<std::size_t>());
    }
    return out;
  }

  ZarrType typeOf(const Metadata& value,
                  std::initializer_list<std::pair<const char*, ZarrType>> known) const {
    for (const auto& [name, type] : known)
      if (value == name) return type;
    fault(fmt::format("numbers of type {}, accepted: uint8, float32, float64", shownValue(value)));
  }

  double fillOf(const Metadata& object) const {
    if (!object.contains("fill_value") || object["fill_value"].is_null()) return 0;
    const Metadata& fill = object["fill_value"];
    if (fill.is_number()) return fill.get<double>();
    if (fill == "NaN") return NAN;
    refuse("fill_value", fill);
  }

  ZarrCodec codecOf(const Metadata& codec, const char* key) const {
    const Metadata& name = codec.is_string() ? codec : at(codec, key);
    if (name == "gzip") return ZarrCodec::gzip;
    if (name == "zlib") return ZarrCodec::zlib;
    if (name == "zstd") return ZarrCodec::zstd;
    if (name == "crc32c") return ZarrCodec::crc32c;
    fault(fmt::format("codec {}, accepted: none, gzip, zlib, zstd", shownValue(name)));
  }

  char separatorOf(const Metadata& object, const char* key, char usual) const {
    if (!object.contains(key)) return usual;
    const Metadata& value = object[key];
    if (value == ".") return '.';
    if (value == "/") return '/';
    refuse(key, value);
  }

  void readKeys(const Metadata& encoding, ZarrLayout& out) const {
    const std::string name = nameOf(encoding);
    if (name != "default" && name != "v2") refuse("chunk_key_encoding", name);
    if (name == "v2") out.prefix.clear();
    const Metadata settings = settingsOf(encoding);
    out.separator = separatorOf(settings, "separator", name == "v2" ? '.' : '/');
    if (!out.prefix.empty()) out.prefix.back() = out.separator;
  }

  void product(const std::vector<std::size_t>& sides, std::size_t most, const char* key,
               const char* of) const {
    std::size_t count = 1;
    for (const std::size_t side : sides) {
      if (side > most / count) fault(fmt::format("{}: more than {} {}", key, most, of));
      count *= side;
    }
  }

  const Metadata& json_;
  const std::string& name_;
};

std::size_t productOf(const std::vector<std::size_t>& sides) {
  std::size_t count = 1;
  for (const std::size_t side : sides) count *= side;
  return count;
}

}  // namespace

std::size_t ZarrLayout::valueBytes() const {
  return type == ZarrType::uint8 ? 1 : type == ZarrType::float32 ? 4 : 8;
}

std::size_t ZarrLayout::values() const {
  return productOf(shape);
}

std::size_t ZarrLayout::chunkValues() const {
  return productOf(chunk);
}

std::vector<std::size_t> ZarrLayout::grid() const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < shape.size(); ++i) out.push_back((shape[i] - 1) / chunk[i] + 1);
  return out;
}

Metadata zarrJson(std::string_view text, const std::string& name) {
  constexpr int kDeepest = 64;
  bool deep = false;
  const Metadata json = Metadata::parse(
      text.begin(), text.end(),
      [&](int depth, Metadata::parse_event_t, Metadata&) {
        deep = deep || depth > kDeepest;
        return !deep;
      },
      false);
  if (deep || !json.is_object()) throw SceneError(fmt::format("{}: is no JSON object", name));
  return json;
}

ZarrLayout zarrLayout(std::string_view text, int version, const std::string& name) {
  const Metadata json = zarrJson(text, name);
  if (!json.contains("zarr_format") || json["zarr_format"] != version)
    throw SceneError(fmt::format("{}: zarr_format is not {}", name, version));
  const LayoutReader reader(json, name);
  ZarrLayout layout = version == 2 ? reader.version2() : reader.version3();
  reader.check(layout);
  return layout;
}

}  // namespace echocine
