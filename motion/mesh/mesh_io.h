#pragma once
// Mesh files of one keyframe, or meshes in memory -> one triangle mesh.

#include "core/hash.h"
#include "motion/mesh/mesh.h"
#include "scene/scene.h"

namespace echocine {

// Reads an OBJ, PLY, OFF or STL file, told apart by its extension; its bytes go into the digest.
// Polygons become triangle fans. Throws SceneError that starts with the file's name.
TriangleMesh readMesh(const std::filesystem::path& file, Sha256& digest);

// The keyframe's mesh with its lids appended. A lid's vertex with exactly the coordinates of one
// that is already there is welded to it, so lids can close a mesh and each other. Every file is
// checked by itself (checkFile) before it is joined; faces with two corners in one vertex pass
// where the structure asks for their repair. Throws SceneError that starts with the structure's
// place and name.
KeyframeMesh readKeyframe(const Keyframe& keyframe, const Structure& structure, Sha256& digest);

}  // namespace echocine
