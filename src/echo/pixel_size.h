#pragma once
// Shape and size of pixels, by the user and by the regions of a DICOM file.

#include "echo/read_loop.h"

namespace echocine::echo {

// Makes pixels square that the user, or else the file's regions, state as oblong: pictures are
// stretched in height. With a sector that is given, in pixels of the picture as it is stored, the
// regions' word is only noted.
void takeAspect(const SideOptions& side, Video& video);

// The scale of the region that holds the sector, with notes about regions that cannot be right.
void scaleFromRegions(EchoLoop& loop);

}  // namespace echocine::echo
