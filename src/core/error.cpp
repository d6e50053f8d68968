#include "core/error.h"

namespace echocine {

std::string atPlace(const SourcePlace& place, const std::string& what) {
  std::string text = place.file;
  if (place.line > 0) {
    text += ':';
    text += std::to_string(place.line);
  }
  if (!text.empty()) text += ": ";
  if (!place.key.empty()) text += place.key + ": ";
  return text + what;
}

}  // namespace echocine
