#pragma once
// The errors of a setting's pictures against the reference's.

#include <vector>

#include "study/study.h"

namespace echocine {

// Fills the point's errors, and the pictures of its worst frame. Precondition: as many pictures as
// references, of the same frames and sizes.
void compareWith(const std::vector<FramePicture>& reference,
                 const std::vector<FramePicture>& pictures, double dynamic_range_db,
                 StudyPoint& point);

}  // namespace echocine
