#include "motion/mesh/openmesh_turn.h"

#include <OpenMesh/Core/System/omstream.hh>

namespace echocine {

std::unique_lock<std::mutex> takeOpenMesh() {
  static std::mutex mutex;
  std::unique_lock lock(mutex);
  omerr().disable();
  omlog().disable();
  return lock;
}

}  // namespace echocine
