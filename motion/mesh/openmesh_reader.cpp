#include "motion/mesh/openmesh_reader.h"

#include <fmt/format.h>

// MeshIO.hh registers the readers; it must come with the manager.
#include <OpenMesh/Core/IO/IOManager.hh>
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string_view>

#include "core/error.h"
#include "motion/mesh/openmesh_turn.h"
#include "motion/mesh/ply_header.h"

namespace echocine {

namespace {

namespace om = OpenMesh;

// Collects vertices and faces of the file unchanged. The half-edge kernel would drop or duplicate
// non-manifold faces, and a silently dropped face is an undetected leak.
class PlainImporter final : public om::IO::BaseImporter {
 public:
  TriangleMesh mesh;

  om::VertexHandle add_vertex(const om::Vec3f& p) override { return addPoint(p); }
  om::VertexHandle add_vertex(const om::Vec3d& p) override { return addPoint(p); }
  om::VertexHandle add_vertex() override { return addPoint(om::Vec3f(0, 0, 0)); }
  void set_point(om::VertexHandle vertex, const om::Vec3f& p) override {
    mesh.positions.at(static_cast<std::size_t>(vertex.idx())) = {p[0], p[1], p[2]};
  }
  om::FaceHandle add_face(const VHandles& corners) override {
    ++face_count_;
    if (corners.size() < 3)
      throw SceneError(fmt::format("face {} has {} corners, at least 3 are needed", face_count_,
                                   corners.size()));
    if (mesh.triangles.size() + corners.size() > kMaxMeshTriangles)
      throw SceneError(fmt::format("more than {} triangles", kMaxMeshTriangles));
    numbers_.clear();
    for (const om::VertexHandle corner : corners) numbers_.push_back(number(corner));
    appendFan(numbers_, face_count_ - 1, mesh);
    return om::FaceHandle(static_cast<int>(face_count_ - 1));
  }
  std::size_t n_vertices() const override { return mesh.positions.size(); }
  std::size_t n_faces() const override { return face_count_; }
  std::size_t n_edges() const override { return 0; }

  // Other content of a file does not affect a surface's shape.
  om::HalfedgeHandle add_edge(om::VertexHandle, om::VertexHandle) override {
    return om::HalfedgeHandle();
  }
  om::FaceHandle add_face(om::HalfedgeHandle) override { return om::FaceHandle(); }
  void add_face_texcoords(om::FaceHandle, om::VertexHandle,
                          const std::vector<om::Vec2f>&) override {}
  void add_face_texcoords(om::FaceHandle, om::VertexHandle,
                          const std::vector<om::Vec3f>&) override {}
  void set_face_texindex(om::FaceHandle, int) override {}
  void set_halfedge(om::VertexHandle, om::HalfedgeHandle) override {}
  void set_normal(om::VertexHandle, const om::Vec3f&) override {}
  void set_normal(om::VertexHandle, const om::Vec3d&) override {}
  void set_color(om::VertexHandle, const om::Vec3uc&) override {}
  void set_color(om::VertexHandle, const om::Vec4uc&) override {}
  void set_color(om::VertexHandle, const om::Vec3f&) override {}
  void set_color(om::VertexHandle, const om::Vec4f&) override {}
  void set_texcoord(om::VertexHandle, const om::Vec2f&) override {}
  void set_status(om::VertexHandle, const om::Attributes::StatusInfo&) override {}
  void set_next(om::HalfedgeHandle, om::HalfedgeHandle) override {}
  void set_face(om::HalfedgeHandle, om::FaceHandle) override {}
  void request_face_texcoords2D() override {}
  void set_texcoord(om::HalfedgeHandle, const om::Vec2f&) override {}
  void set_texcoord(om::VertexHandle, const om::Vec3f&) override {}
  void set_texcoord(om::HalfedgeHandle, const om::Vec3f&) override {}
  void set_status(om::HalfedgeHandle, const om::Attributes::StatusInfo&) override {}
  void set_color(om::EdgeHandle, const om::Vec3uc&) override {}
  void set_color(om::EdgeHandle, const om::Vec4uc&) override {}
  void set_color(om::EdgeHandle, const om::Vec3f&) override {}
  void set_color(om::EdgeHandle, const om::Vec4f&) override {}
  void set_status(om::EdgeHandle, const om::Attributes::StatusInfo&) override {}
  void set_normal(om::FaceHandle, const om::Vec3f&) override {}
  void set_normal(om::FaceHandle, const om::Vec3d&) override {}
  void set_color(om::FaceHandle, const om::Vec3uc&) override {}
  void set_color(om::FaceHandle, const om::Vec4uc&) override {}
  void set_color(om::FaceHandle, const om::Vec3f&) override {}
  void set_color(om::FaceHandle, const om::Vec4f&) override {}
  void set_status(om::FaceHandle, const om::Attributes::StatusInfo&) override {}
  void add_texture_information(int, std::string) override {}

 private:
  template <typename Point>
  om::VertexHandle addPoint(const Point& p) {
    if (mesh.positions.size() == kMaxMeshVertices)
      throw SceneError(fmt::format("more than {} vertices", kMaxMeshVertices));
    mesh.positions.push_back({p[0], p[1], p[2]});
    return om::VertexHandle(static_cast<int>(mesh.positions.size() - 1));
  }

  // A negative handle becomes a number too large for any mesh, which the checks report.
  static std::uint32_t number(om::VertexHandle vertex) {
    return static_cast<std::uint32_t>(vertex.idx());
  }

  std::vector<std::uint32_t> numbers_;
  std::size_t face_count_ = 0;
};

// Binary STL: 80 arbitrary bytes (often "solid", as in a text file), a 32-bit count, and 50 bytes
// per triangle. Only the size distinguishes it from text.
bool isBinaryStl(const std::string& bytes) {
  if (bytes.size() < 84) return false;
  std::uint32_t triangle_count = 0;
  std::memcpy(&triangle_count, bytes.data() + 80, sizeof triangle_count);
  const std::size_t size = 84 + std::size_t{50} * triangle_count;
  if (bytes.size() == size) return true;
  if (bytes.find('\0') == std::string::npos) return false;
  throw SceneError(fmt::format("binary STL of {} triangles needs {} bytes, the file has {}",
                               triangle_count, size, bytes.size()));
}

void parse(const std::string& bytes, const std::string& extension, PlainImporter& importer) {
  om::IO::Options options;
  const bool stl = extension == "stl";
  if (extension == "ply") checkPlyHeader(bytes);
  if (stl && isBinaryStl(bytes)) options += om::IO::Options::Binary;
  std::istringstream stream(bytes);
  // The PLY and OFF readers know the expected counts and continue after a failure, filling in
  // zeros.
  if (!stl) stream.exceptions(std::ios::failbit | std::ios::badbit);
  const bool good = om::IO::IOManager().read(stream, extension, importer, options);
  // The reader of STL text reads to the end of the file, or stops at text that is not a number.
  const bool stopped_early = stl && !options.check(om::IO::Options::Binary) && !stream.eof();
  if (!good || stopped_early) throw SceneError("is damaged, or not a file of this format");
}

}  // namespace

TriangleMesh parseWithOpenMesh(const std::string& bytes, const std::string& extension) {
  const auto turn = takeOpenMesh();
  PlainImporter importer;
  try {
    parse(bytes, extension, importer);
  } catch (const SceneError&) {
    throw;
  } catch (const std::exception&) {
    throw SceneError(
        fmt::format("ends early or has something else where a number is needed, after "
                    "{} vertices and {} faces",
                    importer.n_vertices(), importer.n_faces()));
  }
  return std::move(importer.mesh);
}

}  // namespace echocine
