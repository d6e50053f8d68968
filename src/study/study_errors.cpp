#include "study/study_errors.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "study/thumbnail.h"

namespace echocine {

void compareWith(const std::vector<FramePicture>& reference,
                 const std::vector<FramePicture>& pictures, double dynamic_range_db,
                 StudyPoint& point) {
  StudyErrors& e = point.errors;
  InterfaceError interfaces;
  double squares = 0, ssim = 0, worst = -1;
  for (std::size_t f = 0; f < pictures.size(); ++f) {
    const FramePicture &picture = pictures[f], &truth = reference[f];
    const PictureError error = pictureError(picture.grey, truth.grey, dynamic_range_db);
    squares += error.rms_db * error.rms_db;
    e.worst_rms_db = std::max(e.worst_rms_db, error.rms_db);
    e.max_db = std::max(e.max_db, error.max_db);
    ssim += structuralSimilarity(picture.image, truth.image, truth.grey);
    interfaces.add(picture.interfaces, truth.interfaces);
    if (error.rms_db > worst) {
      worst = error.rms_db;
      point.thumbnail = thumbnail(picture.image);
      point.difference = differenceThumbnail(picture, truth, dynamic_range_db);
    }
  }
  const auto frames = static_cast<double>(pictures.size());
  // Frames have equally many pixels in the sector, so the mean of their squares is that of all
  // pixels.
  e.rms_db = std::sqrt(squares / frames);
  e.ssim = ssim / frames;
  e.interface_rms_mm = millimetresFromMetres(interfaces.rms_m());
  e.interface_p95_mm = millimetresFromMetres(interfaces.percentile95_m());
  e.interface_missed = interfaces.missedShare();
}

}  // namespace echocine
