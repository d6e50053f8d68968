// The command dataset as calls.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "dataset/join.h"
#include "dataset/make_dataset.h"
#include "dataset/preview.h"
#include "python/bindings.h"
#include "python/job.h"

namespace echocine::python {

namespace {

using Path = std::filesystem::path;

// Without `text` the spec is the file's; else `file` only names it.
dataset::Spec specOf(const std::optional<std::string>& text, const Path& file) {
  return text ? dataset::parseSpec(*text, file) : dataset::readSpec(file);
}

py::dict dictOf(const dataset::MakeSummary& made) {
  py::dict counts;
  counts["loops"] = made.loops;
  counts["bytes"] = made.bytes;
  counts["kept"] = made.kept;
  counts["impossible"] = made.impossible;
  counts["failed"] = made.failed;
  return counts;
}

py::dict makePart(const std::optional<std::string>& text, const Path& file, const Path& folder,
                  std::pair<int, int> task, int threads, const py::object& progress) {
  dataset::MakeSummary made;
  runJob(progress, [&](const Monitor& monitor) {
    const dataset::Spec spec = specOf(text, file);
    made = dataset::makePart(spec, {folder, threads, task.first, task.second}, monitor);
  });
  return dictOf(made);
}

py::dict mergeParts(const std::optional<std::string>& text, const Path& file, const Path& folder,
                    bool fast, int threads, const std::vector<std::pair<Path, double>>& real) {
  dataset::MakeSummary merged;
  runJob(py::none(), [&](const Monitor& monitor) {
    const dataset::Spec spec = specOf(text, file);
    dataset::MergeOptions options{fast, threads};
    for (const auto& [loop, mm_per_pixel] : real) options.real.push_back({loop, mm_per_pixel});
    merged = dataset::mergeParts(spec, folder, options, monitor);
  });
  return dictOf(merged);
}

// Counts, and the layouts that not all parts have.
std::pair<py::dict, std::vector<std::string>> joinParts(const std::vector<Path>& parts,
                                                        const Path& folder,
                                                        const std::optional<std::string>& name,
                                                        const py::object& progress) {
  dataset::JoinSummary joined;
  runJob(progress, [&](const Monitor& monitor) {
    joined = dataset::joinDatasets(parts, folder, {name}, monitor);
  });
  py::dict counts;
  counts["hearts"] = joined.hearts;
  counts["loops"] = joined.loops;
  counts["failed"] = joined.failed;
  return {counts, joined.left_out};
}

py::dict preview(const std::optional<std::string>& text, const Path& file, const Path& page,
                 int hearts, int threads, const py::object& progress) {
  dataset::PreviewSummary made;
  runJob(progress, [&](const Monitor& monitor) {
    made = dataset::writePreview(specOf(text, file), page, hearts, threads, monitor);
  });
  py::dict numbers;
  numbers["hearts"] = made.pictures;
  numbers["impossible"] = made.impossible;
  numbers["seconds"] = made.seconds;
  numbers["bytes"] = made.bytes;
  return numbers;
}

}  // namespace

void bindDataset(py::module_& module) {
  module.def("make_dataset", &makePart, py::arg("text").none(true), py::arg("file"),
             py::arg("folder"), py::arg("task"), py::arg("threads"), py::arg("progress").none(true),
             "Renders a part of the hearts; returns counts.");
  module.def("merge_dataset", &mergeParts, py::arg("text").none(true), py::arg("file"),
             py::arg("folder"), py::arg("fast"), py::arg("threads"), py::arg("real"),
             "Verifies all hearts' files, writes tables and lists; returns counts.");
  module.def("join_datasets", &joinParts, py::arg("parts"), py::arg("folder"),
             py::arg("name").none(true), py::arg("progress").none(true),
             "Joins finished datasets; returns counts, and the layouts that were left out.");
  module.def(
      "preview_dataset", &preview, py::arg("text").none(true), py::arg("file"), py::arg("page"),
      py::arg("hearts"), py::arg("threads"), py::arg("progress").none(true),
      "A page of some hearts; returns hearts, impossible draws, expected seconds and bytes.");
}

}  // namespace echocine::python
