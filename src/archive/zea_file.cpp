#include "archive/zea_file.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <mutex>
#include <span>

#include "core/error.h"
#include "core/file.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// Debian's library may be used by one thread at a time.
std::mutex& libraryMutex() {
  static std::mutex mutex;
  return mutex;
}

hid_t checkedId(hid_t id) {
  if (id < 0) throw JobError("HDF5 could not make the file");
  return id;
}

class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(checkedId(id)), close_(close) {}
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

class ZeaWriter {
 public:
  ZeaWriter()
      : access_(H5Pcreate(H5P_FILE_ACCESS), H5Pclose),
        links_(H5Pcreate(H5P_LINK_CREATE), H5Pclose),
        text_(H5Tcopy(H5T_C_S1), H5Tclose) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // it would print
    constexpr std::size_t kGrow = std::size_t{1} << 20;
    checkedId(H5Pset_fapl_core(access_, kGrow, false));  // in memory only
    checkedId(H5Pset_create_intermediate_group(links_, 1));
    checkedId(H5Tset_size(text_, H5T_VARIABLE));
    checkedId(H5Tset_cset(text_, H5T_CSET_UTF8));
    file_ = checkedId(H5Fcreate("memory.h5", H5F_ACC_TRUNC, H5P_DEFAULT, access_));
  }
  ~ZeaWriter() { H5Fclose(file_); }

  void add(const char* path, const std::vector<hsize_t>& shape,
           std::span<const std::uint8_t> values) {
    addArray(path, shape, H5T_STD_U8LE, H5T_NATIVE_UINT8, values.data());
  }
  void add(const char* path, const std::vector<hsize_t>& shape, std::span<const float> values) {
    addArray(path, shape, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, values.data());
  }
  void add(const char* path, float value) { add(path, {}, std::span(&value, 1)); }
  void add(const char* path, const std::string& text) {
    const char* const data = text.c_str();
    addArray(path, {}, text_, text_, static_cast<const void*>(&data));
  }
  void attribute(const char* name, const std::string& text) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle made(H5Acreate2(file_, name, text_, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const char* const data = text.c_str();
    checkedId(H5Awrite(made, text_, static_cast<const void*>(&data)));
  }

  std::vector<std::byte> bytes() {
    checkedId(H5Fflush(file_, H5F_SCOPE_GLOBAL));
    std::vector<std::byte> bytes(
        static_cast<std::size_t>(checkedId(H5Fget_file_image(file_, nullptr, 0))));
    checkedId(H5Fget_file_image(file_, bytes.data(), bytes.size()));
    return bytes;
  }

 private:
  // Planes over time are compressed frame by frame.
  void addArray(const char* path, const std::vector<hsize_t>& shape, hid_t stored, hid_t given,
                const void* data) {
    const Handle space(
        shape.empty() ? H5Screate(H5S_SCALAR)
                      : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
        H5Sclose);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    checkedId(H5Pset_obj_track_times(properties, false));
    if (shape.size() == 3) {
      std::vector<hsize_t> chunk = shape;
      chunk.front() = 1;
      constexpr unsigned kDeflate = 6;  // zlib's own
      checkedId(H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data()));
      checkedId(H5Pset_deflate(properties, kDeflate));
    }
    const Handle set(H5Dcreate2(file_, path, stored, space, links_, properties, H5P_DEFAULT),
                     H5Dclose);
    checkedId(H5Dwrite(set, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, data));
  }

  Handle access_, links_, text_;
  hid_t file_ = -1;
};

// Centres of the samples: lateral, elevation, depth in the probe frame.
std::vector<float> coordinatesOf(const BeamLoop& loop) {
  const ScanGeometry geometry(loop.scene.probe);
  std::vector<float> places_m;
  for (int k = 0; k < loop.samples; ++k)
    for (int i = 0; i < loop.lines; ++i) {
      const LineGeometry line = lineGeometry(loop.scene.probe, i);
      const Vec3d p = line.origin + geometry.sampleDepth(k) * line.direction;
      for (const double along : {p.x, p.y, p.z}) places_m.push_back(static_cast<float>(along));
    }
  return places_m;
}

}  // namespace

void writeZea(const BeamLoop& loop, const std::filesystem::path& file, const std::string& subject) {
  if (subject.find_first_not_of(' ') == std::string::npos)
    throw SceneError("--exam: is empty, accepted: a name");
  const hsize_t t = static_cast<hsize_t>(loop.frames), z = static_cast<hsize_t>(loop.samples),
                x = static_cast<hsize_t>(loop.lines);
  const std::vector<float> coordinates = coordinatesOf(loop);
  std::vector<std::byte> bytes;
  {
    const std::lock_guard one_at_a_time(libraryMutex());
    ZeaWriter writer;
    writer.attribute("zea_version", "dev");
    writer.attribute("probe_name", "generic");
    writer.attribute("description",
                     fmt::format("EchoCine {}, scene {}", ECHOCINE_VERSION, loop.scene_sha256));
    writer.add("tracks/track_0/data/image/values", {t, z, x}, bytesOfGreys(loop));
    writer.add("tracks/track_0/data/image/coordinates", {z, x, 3}, coordinates);
    writer.add("tracks/track_0/data/tissue_doppler/values", {t, z, x}, loop.beam_m_s);
    writer.add("tracks/track_0/data/tissue_doppler/coordinates", {z, x, 3}, coordinates);
    writer.add("tracks/track_0/data/tissue_doppler/unit", std::string("m/s"));
    writer.add("metadata/subject/id", subject);
    writer.add("metadata/ecg/samples", {loop.ecg.size()}, loop.ecg);
    writer.add("metadata/ecg/sampling_frequency", static_cast<float>(kEcgRate_hz));
    writer.add("metadata/ecg/start_time_offset", 0.0f);
    if (!loop.strain_percent.empty()) {
      const auto rate_hz = static_cast<float>(loop.scene.acquisition.frame_rate_hz);
      writer.add("metadata/longitudinal_strain/samples", {t}, loop.strain_percent);
      writer.add("metadata/longitudinal_strain/sampling_frequency", rate_hz);
      writer.add("metadata/longitudinal_strain/start_time_offset", 0.0f);
    }
    bytes = writer.bytes();
  }
  writeFileWhole(file, bytes);
}

}  // namespace echocine
