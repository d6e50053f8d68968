#include "dataset/folder_spec.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"

namespace echocine::dataset {

namespace {

constexpr std::size_t kMostTextBytes = std::size_t{1} << 20;

std::filesystem::path sourceFile(const std::filesystem::path& folder) {
  return folder / "work/source.json";
}

// The spec's file as source.json names it; the folder's copy without one.
std::filesystem::path sourceOf(const std::filesystem::path& folder) {
  const std::filesystem::path copy = folder / "spec.toml";
  if (!isOrdinaryFile(sourceFile(folder))) return copy;
  const auto json =
      nlohmann::json::parse(readTextFile(sourceFile(folder), kMostTextBytes), nullptr, false);
  if (!json.is_object() || !json.contains("file") || !json["file"].is_string()) return copy;
  return json["file"].get<std::string>();
}

void writeIfOther(const std::filesystem::path& file, const std::string& text) {
  if (isOrdinaryFile(file)) {
    try {
      if (readTextFile(file, kMostTextBytes) == text) return;
    } catch (const SceneError&) {  // unreadable or too large: replaced
    }
  }
  writeFileWhole(file, std::as_bytes(std::span(text)));
}

}  // namespace

Spec readFolderSpec(const std::filesystem::path& folder) {
  const std::filesystem::path copy = folder / "spec.toml";
  if (!isOrdinaryFile(copy)) throw SceneError(fmt::format("{}: holds no dataset", folder.string()));
  return parseSpec(readTextFile(copy, kMostTextBytes), sourceOf(folder));
}

void keepFolderSpec(const std::filesystem::path& folder, const Spec& spec) {
  const std::filesystem::path copy = folder / "spec.toml";
  writeIfOther(copy, spec.text);
  std::error_code failed;
  if (std::filesystem::equivalent(copy, spec.file, failed)) return;  // its source is unknown
  const std::filesystem::path file =
      spec.scenes.empty() ? spec.file.filename() : std::filesystem::absolute(spec.file);
  const nlohmann::json source{{"file", file.string()}};
  writeIfOther(sourceFile(folder),
               source.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace echocine::dataset
