#pragma once
// File names of meshes in the text of a scene.

#include <filesystem>
#include <string>

namespace echocine::heart {
struct Recording;
}

namespace echocine::live {

// The text of a scene in folder `from` as one in folder `to`: relative names of mesh files, in
// quotes outside of comments, refer to the same files. Unchanged if the folders are the same.
std::string withMeshesFrom(const std::string& text, const std::filesystem::path& from,
                           const std::filesystem::path& to);

// A heart's scene with the names that its keyframes have in memory, those of OBJ files, in place of
// its .npz files.
std::string withNamesInMemory(std::string text, const heart::Recording& recording);

}  // namespace echocine::live
