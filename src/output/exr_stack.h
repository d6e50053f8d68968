#pragma once
// The intensity stack: one OpenEXR file per frame in beam space, x = scan line, y = sample.
//
// Precision: 32-bit floats are exact. Compression pxr24 keeps 15 binary digits, a relative error of
// at most 2^-16. Half floats follow half_plane.h; the header's echocine:scale.<channel> is the
// factor of the stored values. display.Y is not scaled. medium.id is always exact. Each file
// contains its own digest, exr_digest.h.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/file_group.h"
#include "output/frame_record.h"
#include "scene/scene.h"
#include "trace/channel_plane.h"

namespace echocine {

class ExrStack {
 public:
  // Files are `folder`/frame_0000.exr and so on. scene_sha256 and reference_intensity are written
  // to every header. Precondition: the scene outlives the stack.
  ExrStack(std::filesystem::path folder, const Scene& scene, std::string scene_sha256,
           double reference_intensity);

  // The bytes of the frame's file, in a buffer of this thread that the next encoding reuses.
  // Thread-safe. Throws JobError naming frame, line and sample for a negative or non-finite value.
  std::span<const std::byte> encode(const FrameRecord& record,
                                    const std::vector<ChannelPlane>& planes) const;

  // Encodes, writes a temporary file and renames it. Returns the SHA-256 of the file. Thread-safe.
  // Throws JobError like encode(), and if the file cannot be written.
  std::string write(const FrameRecord& record, const std::vector<ChannelPlane>& planes) const;

  // The same, up to the renaming: the file gets its name with a FileGroup.
  PendingFile prepare(const FrameRecord& record, const std::vector<ChannelPlane>& planes,
                      std::string& sha256) const;

  // The SHA-256 of an existing complete file of this scene and frame. Empty if it is absent,
  // truncated, changed in any byte, or of another size, frame, channel list, reference or program
  // version. Thread-safe. Throws SceneError if the file is complete but belongs to another scene.
  std::string existing(const FrameRecord& record) const;

  // Does the frame's file exist with a header of another scene, complete or not?
  bool isOfAnotherScene(int frame) const;

  // Throws SceneError if isOfAnotherScene().
  void refuseOtherScene(int frame) const;

  static std::string fileName(int frame);  // "frame_0000.exr"

 private:
  std::filesystem::path folder_;
  const Scene& scene_;
  std::string scene_sha256_;
  double reference_intensity_;
  std::string probe_json_;
};

}  // namespace echocine
