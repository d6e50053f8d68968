#include "hdf/hdf5_file.h"

#include <functional>
#include <numeric>

#include "core/check.h"
#include "hdf/hdf5_library.h"

namespace echocine {

namespace {

class MemoryFile {
 public:
  // In memory only: files are written by the one way that survives a crash.
  MemoryFile()
      : access_(H5Pcreate(H5P_FILE_ACCESS), H5Pclose),
        links_(H5Pcreate(H5P_LINK_CREATE), H5Pclose),
        text_(H5Tcopy(H5T_C_S1), H5Tclose) {
    constexpr std::size_t kGrow = std::size_t{1} << 20;
    checkedHdf5(H5Pset_fapl_core(access_, kGrow, false));
    checkedHdf5(H5Pset_create_intermediate_group(links_, 1));
    checkedHdf5(H5Tset_size(text_, H5T_VARIABLE));
    checkedHdf5(H5Tset_cset(text_, H5T_CSET_UTF8));
    file_ = checkedHdf5(H5Fcreate("memory.h5", H5F_ACC_TRUNC, H5P_DEFAULT, access_));
  }
  ~MemoryFile() { H5Fclose(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  void add(const Hdf5Attribute& attribute) {
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle made(
        H5Acreate2(file_, attribute.name.c_str(), text_, space, H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose);
    const char* const data = attribute.text.c_str();
    checkedHdf5(H5Awrite(made, text_, static_cast<const void*>(&data)));
  }

  void add(const Hdf5Array& array) {
    if (const auto* bytes = std::get_if<std::span<const std::uint8_t>>(&array.values))
      return write(array, bytes->size(), H5T_STD_U8LE, H5T_NATIVE_UINT8, bytes->data());
    if (const auto* floats = std::get_if<std::span<const float>>(&array.values))
      return write(array, floats->size(), H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, floats->data());
    const char* const text = std::get<std::string>(array.values).c_str();
    write(array, 1, text_, text_, static_cast<const void*>(&text));
  }

  std::vector<std::byte> bytes() const {
    checkedHdf5(H5Fflush(file_, H5F_SCOPE_GLOBAL));
    std::vector<std::byte> bytes(
        static_cast<std::size_t>(checkedHdf5(H5Fget_file_image(file_, nullptr, 0))));
    checkedHdf5(H5Fget_file_image(file_, bytes.data(), bytes.size()));
    return bytes;
  }

 private:
  void write(const Hdf5Array& array, std::size_t given, hid_t stored, hid_t native,
             const void* data) {
    const std::size_t count = std::accumulate(array.shape.begin(), array.shape.end(),
                                              std::size_t{1}, std::multiplies<>());
    CHECK_EQ(count, given);
    std::vector<hsize_t> shape(array.shape.begin(), array.shape.end());
    const int dimensions = static_cast<int>(shape.size());
    const Hdf5Handle space(
        shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(dimensions, shape.data(), nullptr),
        H5Sclose);
    const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    checkedHdf5(H5Pset_obj_track_times(properties, false));
    if (array.compressed && count > 0) {
      constexpr unsigned kDeflate = 6;  // zlib's own
      shape.front() = 1;
      checkedHdf5(H5Pset_chunk(properties, dimensions, shape.data()));
      checkedHdf5(H5Pset_deflate(properties, kDeflate));
    }
    const Hdf5Handle set(
        H5Dcreate2(file_, array.name.c_str(), stored, space, links_, properties, H5P_DEFAULT),
        H5Dclose);
    checkedHdf5(H5Dwrite(set, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, data));
  }

  Hdf5Handle access_, links_, text_;
  hid_t file_ = -1;
};

}  // namespace

std::vector<std::byte> hdf5Bytes(std::span<const Hdf5Array> arrays,
                                 std::span<const Hdf5Attribute> attributes) {
  const std::lock_guard lock(hdf5Mutex());
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // it would print
  MemoryFile file;
  for (const Hdf5Attribute& attribute : attributes) file.add(attribute);
  for (const Hdf5Array& array : arrays) file.add(array);
  return file.bytes();
}

}  // namespace echocine
