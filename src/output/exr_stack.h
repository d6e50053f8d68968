#pragma once
// The intensity stack: one OpenEXR file per frame in beam space, x = scan line, y = sample.
//
// What a pixel keeps of its value: 32-bit floats every bit; with compression pxr24 15 binary digits
// behind the point, a relative error of 2^-16 at most; half floats as half_plane.h has it, where
// the header's echocine:scale.<channel> is what the value was multiplied by; display.Y has none.
// medium.id is always whole. Each file holds a digest of itself, exr_digest.h.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "output/frame_record.h"
#include "scene/scene.h"
#include "trace/channel_plane.h"

namespace echocine {

class ExrStack {
 public:
  // Files go to `folder`/frame_0000.exr and so on. scene_sha256 and reference_intensity go into
  // every header. Precondition: the scene outlives the stack.
  ExrStack(std::filesystem::path folder, const Scene& scene, std::string scene_sha256,
           double reference_intensity);

  // The bytes of the frame's file, in memory of this thread until it encodes again. Thread-safe.
  // Throws JobError: a value is negative or not finite (names frame, line and sample).
  std::span<const std::byte> encode(const FrameRecord& record,
                                    const std::vector<ChannelPlane>& planes) const;

  // Encodes, writes beside and renames. Returns the SHA-256 of the file. Thread-safe. Throws
  // JobError as encode() does, and when the file cannot be written.
  std::string write(const FrameRecord& record, const std::vector<ChannelPlane>& planes) const;

  // The SHA-256 of an existing whole file of this very scene and frame, or empty when there is
  // none: absent, truncated, with a byte other than was written, of another size, frame, channel
  // list, reference or program version. Thread-safe. Throws SceneError when the file is whole but
  // belongs to another scene.
  std::string existing(const FrameRecord& record) const;

  // Whether the frame's file is there and its header is of another scene, whether or not the pixels
  // are whole.
  bool isOfAnotherScene(int frame) const;

  // Throws SceneError where isOfAnotherScene().
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
