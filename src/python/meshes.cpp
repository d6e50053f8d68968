#include "python/meshes.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cmath>
#include <cstring>

#include "python/arrays.h"
#include "python/bindings.h"

namespace echocine::python {

namespace {

using Points = py::array_t<double, py::array::c_style>;
using Faces = py::array_t<std::int64_t, py::array::c_style>;

void checkShape(const std::string& name, const py::array& array, const char* accepted) {
  if (array.ndim() != 2 || array.shape(1) != 3 || array.shape(0) == 0)
    throw py::value_error(fmt::format("{}: is {}, accepted: {}", name, shown(array), accepted));
}

std::vector<Vec3d> positionsOf(const std::string& name, const Points& points) {
  checkShape(name + ": points", points, "(V, 3) with V from 1");
  const auto at = points.unchecked<2>();
  std::vector<Vec3d> positions;
  positions.reserve(static_cast<std::size_t>(at.shape(0)));
  for (py::ssize_t i = 0; i < at.shape(0); ++i) {
    const Vec3d p{at(i, 0), at(i, 1), at(i, 2)};
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw py::value_error(fmt::format(
          "{}: points: row {} is ({}, {}, {}), accepted: finite numbers", name, i, p.x, p.y, p.z));
    positions.push_back(p);
  }
  return positions;
}

std::vector<Triangle> trianglesOf(const std::string& name, const Faces& faces, std::size_t points) {
  checkShape(name + ": faces", faces, "(F, 3) with F from 1, triangles");
  const auto at = faces.unchecked<2>();
  std::vector<Triangle> triangles(static_cast<std::size_t>(at.shape(0)));
  for (py::ssize_t i = 0; i < at.shape(0); ++i)
    for (py::ssize_t k = 0; k < 3; ++k) {
      if (at(i, k) < 0 || at(i, k) >= static_cast<std::int64_t>(points))
        throw py::value_error(
            fmt::format("{}: faces: row {} holds vertex {}, accepted: 0 to {}, a row of points",
                        name, i, at(i, k), static_cast<std::int64_t>(points) - 1));
      triangles[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] =
          static_cast<std::uint32_t>(at(i, k));
    }
  return triangles;
}

void add(Meshes& meshes, const std::string& name, const Points& points, const Faces& faces) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = positionsOf(name, points);
  mesh->triangles = trianglesOf(name, faces, mesh->positions.size());
  meshes.named[name] = std::move(mesh);
  meshes.heart_truth.clear();
}

// With tags, whatever they are to subdivision.
void addLike(Meshes& meshes, const std::string& name, const std::string& like,
             const Points& points) {
  const auto found = meshes.named.find(like);
  if (found == meshes.named.end())
    throw py::key_error(fmt::format("{}: is not a mesh in memory", like));
  auto mesh = std::make_shared<TriangleMesh>(*found->second);
  mesh->positions = positionsOf(name, points);
  if (mesh->positions.size() != found->second->positions.size())
    throw py::value_error(fmt::format("{}: points: {} rows, accepted: {}, as its faces have", name,
                                      mesh->positions.size(), found->second->positions.size()));
  meshes.named[name] = std::move(mesh);
  meshes.heart_truth.clear();
}

py::tuple get(const Meshes& meshes, const std::string& name) {
  const auto found = meshes.named.find(name);
  if (found == meshes.named.end())
    throw py::key_error(fmt::format("{}: is not a mesh in memory", name));
  const TriangleMesh& mesh = *found->second;
  // A new pointer to the same mesh keeps it alive for as long as its arrays.
  using Owner = std::shared_ptr<const TriangleMesh>;
  const py::capsule owner(new Owner(found->second), [](void* p) { delete static_cast<Owner*>(p); });
  static_assert(sizeof(Vec3d) == 3 * sizeof(double) &&
                sizeof(Triangle) == 3 * sizeof(std::uint32_t));
  py::array points = viewOf(&mesh.positions.data()->x,
                            {static_cast<py::ssize_t>(mesh.positions.size()), 3}, owner);
  py::array faces = viewOf(mesh.triangles.data()->data(),
                           {static_cast<py::ssize_t>(mesh.triangles.size()), 3}, owner);
  // Shared by scenes and simulators.
  points.attr("flags").attr("writeable") = false;
  faces.attr("flags").attr("writeable") = false;
  return py::make_tuple(points, faces);
}

// The pickled form of a mesh: its numbers as bytes.
template <typename T>
py::bytes bytesOf(const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

template <typename T>
std::vector<T> valuesOf(const py::handle& bytes) {
  const auto text = bytes.cast<std::string>();
  std::vector<T> values(text.size() / sizeof(T));
  std::memcpy(values.data(), text.data(), values.size() * sizeof(T));
  return values;
}

py::tuple stateOf(const Meshes& meshes) {
  py::tuple state(1 + meshes.named.size());
  state[0] = meshes.heart_truth;
  std::size_t i = 1;
  for (const auto& [name, mesh] : meshes.named)
    state[i++] = py::make_tuple(name, bytesOf(mesh->positions), bytesOf(mesh->triangles),
                                bytesOf(mesh->tags.edges), bytesOf(mesh->tags.vertices));
  return state;
}

Meshes fromState(const py::tuple& state) {
  Meshes meshes;
  meshes.heart_truth = state[0].cast<std::string>();
  for (std::size_t i = 1; i < state.size(); ++i) {
    const auto parts = state[i].cast<py::tuple>();
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->positions = valuesOf<Vec3d>(parts[1]);
    mesh->triangles = valuesOf<Triangle>(parts[2]);
    mesh->tags = {valuesOf<SharpEdge>(parts[3]), valuesOf<SharpVertex>(parts[4])};
    meshes.named[parts[0].cast<std::string>()] = std::move(mesh);
  }
  return meshes;
}

}  // namespace

Meshes meshesOf(const Scene& scene) {
  Meshes meshes;
  for (const Structure& structure : scene.structures)
    for (const Keyframe& keyframe : structure.keyframes)
      for (std::size_t i = 0; i < keyframe.meshes.size(); ++i)
        meshes.named[keyframe.files[i].string()] = keyframe.meshes[i];
  return meshes;
}

void bindMeshes(py::module_& module) {
  py::class_<Meshes>(module, "Meshes", "Keyframe meshes in memory, by name.")
      .def(py::init<>())
      .def(py::pickle(&stateOf, &fromState))
      .def(
          "copy", [](const Meshes& meshes) { return meshes; }, "The same meshes, not copied.")
      .def(
          "names",
          [](const Meshes& meshes) {
            std::vector<std::string> names;
            for (const auto& entry : meshes.named) names.push_back(entry.first);
            return names;
          },
          "Names, sorted.")
      .def("add", &add, py::arg("name"), py::arg("points"), py::arg("faces"),
           "Adds or replaces: points (V, 3) float64, faces (F, 3) int64. Copies.")
      .def(
          "add_like", &addLike, py::arg("name"), py::arg("like"), py::arg("points"),
          "Adds or replaces with the faces and subdivision tags of another: points (V, 3) float64.")
      .def("get", &get, py::arg("name"), "Read-only views (V, 3) float64 and (F, 3) uint32.");
}

}  // namespace echocine::python
