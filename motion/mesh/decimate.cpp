#include "motion/mesh/decimate.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>

#include "motion/mesh/openmesh_turn.h"

namespace echocine {

namespace {

namespace om = OpenMesh;
// Double: quadrics of small triangles vanish in single precision.
using HalfEdges = om::TriMesh_ArrayKernelT<om::DefaultTraitsDouble>;

// The kernel's mesh, and the original's vertex that each of its vertices is.
struct Collapsible {
  HalfEdges mesh;
  std::vector<std::uint32_t> original;

  om::VertexHandle add(std::uint32_t vertex, std::span<const Vec3f> positions) {
    const Vec3d p = toDouble(positions[vertex]);
    original.push_back(vertex);
    return mesh.add_vertex({p.x, p.y, p.z});
  }
};

// Faces that the kernel rejects, such as a third face at an edge, get separate corners, so none is
// lost.
void addTriangle(const Triangle& t, std::span<const Vec3f> positions, Collapsible& out) {
  const auto handle = [](std::uint32_t i) { return om::VertexHandle(static_cast<int>(i)); };
  if (out.mesh.add_face(handle(t[0]), handle(t[1]), handle(t[2])).is_valid()) return;
  const om::VertexHandle a = out.add(t[0], positions), b = out.add(t[1], positions),
                         c = out.add(t[2], positions);
  out.mesh.add_face(a, b, c);
}

Collapsible halfEdges(std::span<const Triangle> triangles, std::span<const Vec3f> positions) {
  const auto turn = takeOpenMesh();  // the kernel prints messages about rejected faces
  Collapsible out;
  out.mesh.request_vertex_status();
  out.mesh.request_edge_status();
  out.mesh.request_halfedge_status();
  out.mesh.request_face_status();
  out.mesh.request_face_normals();
  out.mesh.reserve(positions.size(), 3 * triangles.size() / 2, triangles.size());
  std::uint32_t count = 0;
  for (const Triangle& t : triangles) count = std::max({count, t[0] + 1, t[1] + 1, t[2] + 1});
  for (std::uint32_t i = 0; i < count; ++i) out.add(i, positions);
  for (const Triangle& t : triangles) addTriangle(t, positions, out);
  out.mesh.update_face_normals();
  for (const om::VertexHandle v : out.mesh.vertices())
    if (out.mesh.is_boundary(v)) out.mesh.status(v).set_locked(true);
  return out;
}

void collapse(HalfEdges& mesh, std::size_t most_triangles) {
  om::Decimater::DecimaterT<HalfEdges> decimater(mesh);
  om::Decimater::ModQuadricT<HalfEdges>::Handle quadric;
  om::Decimater::ModNormalFlippingT<HalfEdges>::Handle flipping;
  decimater.add(quadric);
  decimater.add(flipping);
  decimater.module(quadric).unset_max_err();  // only for ranking; the other module rejects
  decimater.module(flipping).set_max_normal_deviation(80);  // degrees
  if (decimater.initialize()) decimater.decimate_to_faces(0, most_triangles);
}

// Indices of the original, converted to indices into the list of those in use.
DecimatedMesh compacted(std::vector<Triangle> triangles) {
  DecimatedMesh out;
  for (const Triangle& t : triangles) out.vertices.insert(out.vertices.end(), t.begin(), t.end());
  std::sort(out.vertices.begin(), out.vertices.end());
  out.vertices.erase(std::unique(out.vertices.begin(), out.vertices.end()), out.vertices.end());
  for (Triangle& t : triangles)
    for (std::uint32_t& corner : t)
      corner = static_cast<std::uint32_t>(
          std::lower_bound(out.vertices.begin(), out.vertices.end(), corner) -
          out.vertices.begin());
  out.triangles = std::move(triangles);
  return out;
}

}  // namespace

DecimatedMesh decimated(std::span<const Triangle> triangles, std::span<const Vec3f> positions,
                        std::size_t most_triangles) {
  if (triangles.size() <= most_triangles) return compacted({triangles.begin(), triangles.end()});
  Collapsible coarse = halfEdges(triangles, positions);
  collapse(coarse.mesh, most_triangles);
  std::vector<Triangle> kept;
  for (const om::FaceHandle face : coarse.mesh.faces()) {  // without collapsed faces
    Triangle corners{};
    std::size_t i = 0;
    for (const om::VertexHandle v : coarse.mesh.fv_range(face))
      corners[i++] = coarse.original[static_cast<std::size_t>(v.idx())];
    kept.push_back(corners);
  }
  return compacted(std::move(kept));
}

}  // namespace echocine
