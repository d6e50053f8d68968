#pragma once
// The floors of the output stage: a plane into an uncompressed OpenEXR file by the library alone,
// and a picture through OpenCV's JPEG encoder onto the end of a file.

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <cstdio>
#include <opencv2/imgcodecs.hpp>

#include "bench/bench_scene.h"
#include "support/temp_folder.h"

namespace echocine::bench {

class BareFiles {
 public:
  explicit BareFiles(const Scene& scene)
      : lines_(scene.probe.lines),
        samples_(scene.probe.samples),
        width_(scene.output.width),
        height_(scene.output.height),
        loop_(std::fopen((folder_ / "loop").c_str(), "wb")) {
    Imf::setGlobalThreadCount(0);
  }
  ~BareFiles() { std::fclose(loop_); }
  BareFiles(const BareFiles&) = delete;
  BareFiles& operator=(const BareFiles&) = delete;

  // Files that are replaced cost more than new ones.
  void clear() {
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      if (entry.path().extension() == ".exr") std::filesystem::remove(entry.path());
  }

  // Rows are depths in the file, so the library gathers them from the lines.
  void exr(const std::vector<float>& plane, std::size_t i) {
    Imf::Header header(lines_, samples_);
    header.compression() = Imf::NO_COMPRESSION;
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    Imf::FrameBuffer buffer;
    buffer.insert("Y",
                  Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(plane.data())),
                             sizeof(float) * static_cast<std::size_t>(samples_), sizeof(float)));
    Imf::OutputFile file((folder_ / fmt::format("{:04}.exr", i)).c_str(), header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(samples_);
  }

  void jpeg(const std::vector<std::uint8_t>& picture, int quality) {
    const cv::Mat view(height_, width_, CV_8UC1, const_cast<std::uint8_t*>(picture.data()));
    cv::imencode(".jpg", view, encoded_, {cv::IMWRITE_JPEG_QUALITY, quality});
    std::fwrite(encoded_.data(), 1, encoded_.size(), loop_);
  }

 private:
  int lines_, samples_, width_, height_;
  support::TempFolder folder_;
  std::FILE* loop_;
  std::vector<std::uint8_t> encoded_;
};

}  // namespace echocine::bench
