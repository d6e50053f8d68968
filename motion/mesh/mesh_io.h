#pragma once
// Mesh files or meshes in memory of one keyframe -> one triangle mesh.

#include <span>
#include <string>
#include <vector>

#include "core/hash.h"
#include "motion/mesh/mesh.h"
#include "scene/scene.h"

namespace echocine {

class NpzFiles;

// Reads an OBJ, PLY, OFF or STL file, by its extension; its bytes are added to the digest. Polygons
// become triangle fans. Throws SceneError that starts with the file's name.
TriangleMesh readMesh(const std::filesystem::path& file, Sha256& digest);

// The keyframe's mesh, of files or names of npz_keyframe.h, with its lids appended. A lid's vertex
// with exactly the coordinates of an existing one is welded to it, so lids can close a mesh and
// each other. Every file is checked separately (checkFile) before it is joined. Faces with two
// equal corners are accepted if the structure requests their repair. Throws SceneError that starts
// with the structure's place and name.
KeyframeMesh readKeyframe(const Keyframe& keyframe, const Structure& structure, Sha256& digest);

// The same without a digest: `texts` gets the bytes of each file, empty for meshes in memory.
// Keyframes of .npz files come from `npz`, which holds the files of the structure. Thread-safe.
// addToDigest() with these texts then gives the digest of the function above.
KeyframeMesh readKeyframe(const Keyframe& keyframe, const Structure& structure, const NpzFiles& npz,
                          std::vector<std::string>& texts);
void addToDigest(const Keyframe& keyframe, std::span<const std::string> texts, Sha256& digest);

}  // namespace echocine
