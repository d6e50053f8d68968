#include "dataset/tables.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "dataset/index_draws.h"

namespace echocine::dataset {

namespace {

// Quoted where a comma, a quote or a line's end asks for it (RFC 4180).
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string fieldOf(const Json& value) {
  if (value.is_null()) return {};
  return value.is_string() ? field(value.get<std::string>()) : value.dump();
}

// All single values of a loop by column, those of tables within it as "offset.tilt_deg".
void flatten(const Json& json, const std::string& prefix, std::map<std::string, std::string>& to,
             std::vector<std::string>& order) {
  for (const auto& [key, value] : json.items()) {
    if (value.is_object()) {
      flatten(value, prefix + key + ".", to, order);
    } else if (!value.is_array()) {
      to[prefix + key] = fieldOf(value);
      order.push_back(prefix + key);
    }
  }
}

std::string loopsTable(std::span<const Json> records) {
  struct LoopRow {
    const Json* record;
    std::map<std::string, std::string> cells;
  };
  std::vector<LoopRow> rows;
  std::vector<std::string> columns;  // those of every loop in their order, then what was drawn
  std::set<std::string> known, drawn;
  for (const Json& record : records)
    for (const Json& loop : record.at("loops")) {
      rows.push_back({&record, {}});
      std::vector<std::string> order;
      flatten(loop, "", rows.back().cells, order);
      for (const std::string& name : order) {
        if (name.starts_with("drawn."))
          drawn.insert(name);
        else if (known.insert(name).second)
          columns.push_back(name);
      }
    }
  columns.insert(columns.end(), drawn.begin(), drawn.end());
  std::string text = "heart,population,split,attempt";
  for (const std::string& column : columns)
    text += "," + (column.starts_with("drawn.") ? column.substr(6) : column);
  text += "\n";
  for (LoopRow& row : rows) {
    const Json& record = *row.record;
    text +=
        fmt::format("{},{},{},{}", fieldOf(record.at("heart")), fieldOf(record.at("population")),
                    fieldOf(record.at("split")), fieldOf(record.at("attempt")));
    for (const std::string& column : columns) text += "," + row.cells[column];
    text += "\n";
  }
  return text;
}

std::string splitsText(std::span<const Json> records) {
  Json splits{{"train", Json::array()}, {"val", Json::array()}, {"test", Json::array()}};
  for (const Json& record : records)
    for (const Json& loop : record.at("loops"))
      splits[record.at("split").get<std::string>()].push_back(loop.at("id"));
  return splits.dump(1) + "\n";
}

std::string impossibleTable(std::span<const Json> records) {
  std::string text = "heart,attempt,reason\n";
  for (const Json& record : records)
    for (std::size_t i = 0; i < record.at("impossible").size(); ++i)
      text += fmt::format("{},{},{}\n", fieldOf(record.at("heart")), i,
                          fieldOf(record.at("impossible").at(i)));
  return text;
}

std::string failedTable(std::span<const Json> failures) {
  std::string text = "heart,seed,reason\n";
  for (const Json& failure : failures)
    text += fmt::format("{},{},{}\n", fieldOf(failure.at("heart")), fieldOf(failure.at("seed")),
                        fieldOf(failure.at("failed")));
  return text;
}

Json countsOf(std::span<const Json> records, std::span<const Json> failures) {
  Json counts{{"hearts", records.size()}, {"loops", 0}, {"frames", 0}, {"impossible_draws", 0}};
  std::map<std::string, int> populations, splits;
  std::size_t loops = 0, frames = 0, impossible = 0;
  for (const Json& record : records) {
    loops += record.at("loops").size();
    impossible += record.at("impossible").size();
    for (const Json& loop : record.at("loops")) frames += loop.at("frames").get<std::size_t>();
    ++populations[record.at("population").get<std::string>()];
    ++splits[record.at("split").get<std::string>()];
  }
  counts["loops"] = loops;
  counts["frames"] = frames;
  counts["impossible_draws"] = impossible;
  counts["failed_hearts"] = failures.size();
  counts["hearts_by_split"] = splits;
  counts["hearts_by_population"] = populations;
  return counts;
}

// The distribution behind index_draws.h.
Json jointlyJson(const heart::HeartGroup& group) {
  return {
      {"indices",
       {"end-diastolic volume / body surface, mL/m2", "sphericity, %", "ejection fraction, %",
        "relative wall thickness, %", "conicity, %", "longitudinal shortening, %"}},
      {"mean", group.mean},
      {"sd", group.sd},
      {"correlation", group.correlation},
      {"body_surface_m2", {{"F", kWomenSurface_m2}, {"M", kMenSurface_m2}, {"sd", kSurfaceSd_m2}}},
      {"dials", heart::kIndexDials},
      {"source", heart::kIndexSource}};
}

}  // namespace

Json distributionsJson(const Spec& spec) {
  Json all = Json::object();
  for (const Population& population : spec.populations) {
    Json& one = all[population.name];
    one["weight"] = population.weight;
    if (population.group) one["jointly"] = jointlyJson(heart::heartGroups()[*population.group]);
    for (const Parameter& p : spec.parametersOf(population)) {
      one["parameters"][p.name] = p.distribution.text();
      if (!p.distribution.source.empty()) one["sources"][p.name] = p.distribution.source;
    }
  }
  return all;
}

DatasetFacts factsOf(const Spec& spec) {
  return {spec.name,
          spec.licence,
          spec.digest,
          spec.layouts,
          {{"seed", spec.seed}, {"distributions", distributionsJson(spec)}},
          fmt::format("| reproduced, byte for byte, by | `echocine dataset spec.toml -o FOLDER` |\n"
                      "| spec | `spec.toml`, SHA-256 {} |\n",
                      spec.digest)};
}

void writeTables(const DatasetFacts& facts, std::span<const Json> records,
                 std::span<const Json> failures, Sink& sink) {
  const Json counts = countsOf(records, failures);
  sink.write("loops.csv", loopsTable(records));
  sink.write("splits.json", splitsText(records));
  sink.write("impossible.csv", impossibleTable(records));
  sink.write("failed.csv", failedTable(failures));
  Json dataset{{"name", facts.name},          {"licence", facts.licence},
               {"version", ECHOCINE_VERSION}, {"spec_sha256", facts.digest},
               {"layouts", facts.layouts},    {"counts", counts}};
  dataset.update(facts.origin);
  sink.write("dataset.json", dataset.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  writeCard(facts, records, counts, sink);
}

}  // namespace echocine::dataset
