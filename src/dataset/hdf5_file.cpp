#include "dataset/hdf5_file.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <functional>
#include <mutex>
#include <numeric>

#include "core/check.h"
#include "core/error.h"

namespace echocine::dataset {

namespace {

// Debian's library may be used by one thread at a time.
std::mutex& hdf5Mutex() {
  static std::mutex mutex;
  return mutex;
}

hid_t checked(hid_t id) {
  if (id < 0) throw JobError("HDF5 has no memory for a file");
  return id;
}

// Closes what it holds.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(checked(id)), close_(close) {}
  ~Hdf5Handle() { close_(id_); }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  hid_t id() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// A chunk is one frame, as readers take them.
void compressFrames(hid_t properties, std::vector<hsize_t> chunk) {
  constexpr unsigned kDeflate = 6;  // zlib's own
  chunk.front() = 1;
  checked(H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data()));
  checked(H5Pset_deflate(properties, kDeflate));
}

void addArray(hid_t file, const Hdf5Array& array) {
  const std::vector<hsize_t> shape(array.shape.begin(), array.shape.end());
  const std::size_t count =
      std::accumulate(array.shape.begin(), array.shape.end(), std::size_t{1}, std::multiplies<>());
  const bool floats = std::holds_alternative<std::span<const float>>(array.values);
  CHECK_EQ(count, std::visit([](const auto& values) { return values.size(); }, array.values));
  const void* const data =
      std::visit([](const auto& values) -> const void* { return values.data(); }, array.values);
  const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                         H5Sclose);
  const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  checked(H5Pset_obj_track_times(properties.id(), false));
  if (!floats && count > 0) compressFrames(properties.id(), shape);
  const Hdf5Handle set(H5Dcreate2(file, array.name.c_str(), floats ? H5T_IEEE_F32LE : H5T_STD_U8LE,
                                  space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
                       H5Dclose);
  checked(H5Dwrite(set.id(), floats ? H5T_NATIVE_FLOAT : H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL,
                   H5P_DEFAULT, data));
}

}  // namespace

std::vector<std::byte> hdf5Bytes(std::span<const Hdf5Array> arrays) {
  const std::lock_guard lock(hdf5Mutex());
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // it would print
  // In memory only: files are written by the one way that survives a crash.
  constexpr std::size_t kGrow = std::size_t{1} << 20;
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  checked(H5Pset_fapl_core(access.id(), kGrow, false));
  const Hdf5Handle file(H5Fcreate("memory.h5", H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose);
  for (const Hdf5Array& array : arrays) addArray(file.id(), array);
  checked(H5Fflush(file.id(), H5F_SCOPE_GLOBAL));
  const auto size = static_cast<std::size_t>(checked(H5Fget_file_image(file.id(), nullptr, 0)));
  std::vector<std::byte> bytes(size);
  checked(H5Fget_file_image(file.id(), bytes.data(), bytes.size()));
  return bytes;
}

}  // namespace echocine::dataset
