#pragma once
// Chunks of a zarr array: from the bytes of a file to values.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "zarr/zarr_metadata.h"

namespace echocine {

// The bytes of a chunk's values; their number is always that of the layout. Never holds more than
// a chunk and its file. Throws SceneError for a damaged chunk, or one of another size.
std::vector<std::byte> decodedChunk(const ZarrLayout& layout, std::vector<std::byte> file,
                                    const std::string& name);

}  // namespace echocine
