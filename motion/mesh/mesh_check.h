#pragma once
// What a mesh must be before rays are sent at it. Every message is one line and numbers faces and
// vertices from 1, as OBJ files do.

#include <span>
#include <string>

#include "motion/mesh/mesh.h"
#include "scene/scene.h"

namespace echocine {

// One file by itself: not empty, coordinates finite, faces with three different vertices that
// exist; `degenerate`: two of them may be one vertex, as it will be repaired. Throws SceneError
// that starts with the file's name.
void checkFile(const TriangleMesh& mesh, const std::filesystem::path& file,
               bool degenerate = false);

// The same vertices and faces in every keyframe. Throws as checkKeyframes does.
void checkSameConnectivity(const Structure& structure, std::span<const KeyframeMesh> keyframes);

// All keyframes of a structure: the same faces in each, and the same creases and corners in each or
// in the first one only; edges with at most two faces, which run them in opposite directions; of a
// plausible size; and unless it is a membrane closed, no bow ties, and neither it nor a separate
// surface of it inside out. Throws SceneError that starts with the structure's place. Precondition:
// at least one keyframe, each of files that passed checkFile.
void checkKeyframes(const Structure& structure, std::span<const KeyframeMesh> keyframes,
                    double mesh_unit_m);

// "lid.obj: face 12", numbered as in that file. Precondition: parts as in a KeyframeMesh.
std::string faceName(std::span<const MeshPart> parts, std::size_t triangle);
inline std::string faceName(const KeyframeMesh& keyframe, std::size_t triangle) {
  return faceName(keyframe.parts, triangle);
}

// Volume enclosed by a closed surface, positive when its faces look outward; cube of the mesh's
// unit. By the divergence theorem, V = 1/6 sum a . (b x c), about a vertex of the surface so that
// distant coordinates do not cancel.
double signedVolume(const TriangleMesh& mesh);

}  // namespace echocine
