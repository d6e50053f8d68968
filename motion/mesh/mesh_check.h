#pragma once
// Requirements for a mesh before tracing. Every message is one line and numbers faces and vertices
// from 1, as OBJ files do.

#include <span>
#include <string>

#include "motion/mesh/mesh.h"
#include "scene/scene.h"

namespace echocine {

// One file: not empty, finite coordinates, faces with three different existing vertices.
// `degenerate`: two of them may be equal, because a repair follows. Throws SceneError that starts
// with the file's name.
void checkFile(const TriangleMesh& mesh, const std::filesystem::path& file,
               bool degenerate = false);

// The same vertices and faces in every keyframe. Throws like checkKeyframes.
void checkSameConnectivity(const Structure& structure, std::span<const KeyframeMesh> keyframes);

// All keyframes of a structure: the same faces; the same creases and corners, or those of the first
// keyframe only; edges of at most two faces with opposite directions; a plausible size. Unless it
// is a membrane: closed, without bow ties, and no inverted surface. Throws SceneError that starts
// with the structure's place. Precondition: at least one keyframe, each of files that passed
// checkFile.
void checkKeyframes(const Structure& structure, std::span<const KeyframeMesh> keyframes,
                    double mesh_unit_m);

// "lid.obj: face 12", numbered as in that file. Precondition: parts as in a KeyframeMesh.
std::string faceName(std::span<const MeshPart> parts, std::size_t triangle);
inline std::string faceName(const KeyframeMesh& keyframe, std::size_t triangle) {
  return faceName(keyframe.parts, triangle);
}

// Volume within a closed surface, positive if its faces look outward; cube of the mesh's unit. By
// the divergence theorem, V = 1/6 sum a . (b x c), relative to a vertex of the surface, so that
// distant coordinates do not cancel.
double signedVolume(const TriangleMesh& mesh);

}  // namespace echocine
