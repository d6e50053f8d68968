#pragma once
// Loops as labs have them: AVI, MP4, GIF and the like, DICOM ultrasound, folders of PNG or JPEG.

#include <cstddef>
#include <filesystem>
#include <span>

#include "video/video.h"

namespace echocine {

// A file, or a folder of PNG or JPEG frames in the order of their names (numbers by value).
// Everything wrong with it is a SceneError of one line that says what to give instead; memory stays
// within the limits of video_builder.h whatever the file promises.
Video readVideo(const std::filesystem::path& path);

// The same for a file's bytes; `name` is for messages.
Video readVideoBytes(const std::string& name, std::span<const std::byte> bytes);

// DICOM by its mark, "DICM" at byte 128 (PS3.10 7.1).
bool looksLikeDicom(std::span<const std::byte> bytes);
Video readDicom(const std::string& name, std::span<const std::byte> bytes);

}  // namespace echocine
