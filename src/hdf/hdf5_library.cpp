#include "hdf/hdf5_library.h"

#include "core/error.h"

namespace echocine {

std::mutex& hdf5Mutex() {
  static std::mutex mutex;
  return mutex;
}

hid_t checkedHdf5(hid_t id) {
  if (id < 0) throw JobError("the HDF5 library failed, or it has no memory");
  return id;
}

}  // namespace echocine
