#pragma once
// Small pictures of a setting for the study's page.

#include <cstddef>
#include <vector>

#include "study/setting_run.h"

namespace echocine {

// A JPEG of the picture, at most 320 pixels wide.
std::vector<std::byte> thumbnail(const GreyImage& image);

// A JPEG of the setting's difference from the reference: black for equal, white from 6 dB on (our
// choice).
inline constexpr double kWhiteDifference_db = 6;
std::vector<std::byte> differenceThumbnail(const FramePicture& setting,
                                           const FramePicture& reference, double dynamic_range_db);

}  // namespace echocine
