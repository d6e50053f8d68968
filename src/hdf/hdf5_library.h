#pragma once
// Parts of the HDF5 library that reader and writer share.

#include <hdf5.h>

#include <mutex>

namespace echocine {

// Debian's library may be used by one thread at a time.
std::mutex& hdf5Mutex();

// Throws JobError for the library's sign of failure.
hid_t checkedHdf5(hid_t id);

// Closes what it holds.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(checkedHdf5(id)), close_(close) {}
  ~Hdf5Handle() { close_(id_); }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

}  // namespace echocine
