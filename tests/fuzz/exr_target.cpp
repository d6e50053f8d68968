#include "core/hash.h"
#include "output/exr_stack.h"
#include "promises.h"
#include "resume_scene.h"
#include "targets.h"

namespace echocine::fuzz {

// Whatever lies where a frame of an earlier run should be: taken for this frame, for another
// scene's, or for none.
void exr(std::string_view bytes) {
  const std::filesystem::path file =
      scratchFile(ExrStack::fileName(kResumeFrame.frame).c_str(), bytes);
  for (const auto& channels : kResumeChannels) {
    const Scene scene = resumeScene(channels);
    const ExrStack stack(scratchFolder(), scene, kResumeHash, kResumeReference);
    accepts([&] { stack.refuseOtherScene(kResumeFrame.frame); });
    accepts([&] {
      const std::string hash = stack.existing(kResumeFrame);
      promise(hash.empty() || hash == sha256HexOfFile(file), "the hash of another file");
    });
  }
}

}  // namespace echocine::fuzz
