#pragma once
// Reader of loops: AVI, MP4, GIF and similar, DICOM ultrasound, folders of PNG or JPEG.

#include <cstddef>
#include <filesystem>
#include <span>

#include "video/video.h"

namespace echocine {

// A file, or a folder of PNG or JPEG frames in the order of their names (numbers by value). Every
// fault is a SceneError of one line that names a remedy; memory stays within the limits of
// video_builder.h for any file.
Video readVideo(const std::filesystem::path& path);

// The same for a file's bytes; `name` is used in messages.
Video readVideoBytes(const std::string& name, std::span<const std::byte> bytes);

// Is it DICOM? By its mark, "DICM" at byte 128 (PS3.10 7.1).
bool looksLikeDicom(std::span<const std::byte> bytes);
Video readDicom(const std::string& name, std::span<const std::byte> bytes);

}  // namespace echocine
