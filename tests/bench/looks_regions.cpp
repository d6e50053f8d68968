#include "looks_regions.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

#include "core/error.h"
#include "core/units.h"
#include "echo/beam_grid.h"
#include "echo/sector.h"
#include "frame/simulator.h"
#include "motion/cycle/cardiac_clock.h"
#include "scene/scene_reader.h"
#include "signal/signal_chain.h"
#include "texture/box_echo.h"
#include "video/read_video.h"

namespace echocine::bench {

namespace {

constexpr double kSample_mm = 0.25, kLine_deg = 0.25;
// How far tissue may go from frame to frame: 60 mm/s at 40 frames a second, and a degree.
constexpr BlockMatchSettings kReach{
    .half_lines = 1, .half_samples = 1, .search_lines = 4, .search_samples = 6};

struct PictureLoop {
  std::vector<PixelPlane> frames;
  int width = 0, height = 0;
  double apex_x = 0, apex_y = 0, mm_per_pixel = 1;  // pixels, from the first one's corner
  double first_deg = 0, last_deg = 0, far_mm = 0;
};

PictureLoop ofScene(const std::string& file) {
  const Simulator simulator(readScene(file));
  PictureLoop loop;
  const PictureGeometry& g = simulator.chain().geometry();
  loop.apex_x = g.origin_x_px;
  loop.apex_y = g.origin_y_px;
  loop.mm_per_pixel = 1e3 * g.metres_per_pixel;
  const Probe& probe = simulator.scene().probe;
  loop.first_deg = degreesFromRadians(probe.first_angle_rad);
  loop.last_deg = degreesFromRadians(probe.last_angle_rad);
  loop.far_mm = 1e3 * probe.max_depth_m;
  Frame frame;
  for (int i = 0; i < simulator.cardiacClock().frameCount(); ++i) {
    simulator.frame(simulator.cardiacClock().at(i).time_s, frame);
    loop.frames.push_back(frame.image.pixels);
  }
  loop.width = frame.image.width;
  loop.height = frame.image.height;
  return loop;
}

PictureLoop ofVideo(const std::string& file, double mm_per_pixel) {
  Video video = readVideo(file);
  const echo::Sector sector = echo::findSector(video).sector;
  PictureLoop loop{.frames = {},
                   .width = video.width,
                   .height = video.height,
                   .apex_x = sector.apex_x,
                   .apex_y = sector.apex_y,
                   .mm_per_pixel = mm_per_pixel,
                   .first_deg = degreesFromRadians(sector.first_rad),
                   .last_deg = degreesFromRadians(sector.last_rad),
                   .far_mm = sector.r_max * mm_per_pixel};
  for (int i = 0; i < video.frameCount(); ++i)
    if (!video.isRepeat(i)) loop.frames.push_back(std::move(video.frames[i]));
  return loop;
}

struct BeamSpace {
  int lines = 0, samples = 0;
  double first_deg = 0;
  std::vector<std::vector<float>> frames;
};

BeamSpace beamSpace(const PictureLoop& loop) {
  BeamSpace space;
  space.first_deg = loop.first_deg;
  space.lines = static_cast<int>((loop.last_deg - loop.first_deg) / kLine_deg) + 1;
  space.samples = static_cast<int>(loop.far_mm / kSample_mm) + 1;
  for (const PixelPlane& frame : loop.frames) {
    const std::vector<float> picture(frame.begin(), frame.end());
    std::vector<float> plane;
    for (int i = 0; i < space.lines; ++i) {
      const double angle = radiansFromDegrees(space.first_deg + kLine_deg * i);
      for (int k = 0; k < space.samples; ++k) {
        const double r = kSample_mm * k / loop.mm_per_pixel;
        plane.push_back(echo::greyAt(picture.data(), loop.width, loop.height,
                                     loop.apex_x + r * std::sin(angle),
                                     loop.apex_y + r * std::cos(angle)));
      }
    }
    space.frames.push_back(std::move(plane));
  }
  return space;
}

void saveFirst(const BeamSpace& space, const std::string& file) {
  std::ofstream out(file, std::ios::binary);
  out << "P5\n" << space.lines << " " << space.samples << "\n255\n";
  for (int k = 0; k < space.samples; ++k)
    for (int i = 0; i < space.lines; ++i)
      out.put(static_cast<char>(static_cast<unsigned char>(
          space.frames.front()[static_cast<std::size_t>(i * space.samples + k)])));
}

void printRegion(const BeamSpace& space, const std::string& row) {
  std::istringstream words(row);
  std::string name, word;
  std::getline(words, name, ',');
  std::vector<double> numbers;
  while (std::getline(words, word, ',')) numbers.push_back(std::atof(word.c_str()));
  if (numbers.size() != 5) throw SceneError("a region needs five numbers: " + row);
  const auto sample = [](double mm) { return static_cast<int>(std::lround(mm / kSample_mm)); };
  const auto line = [&](double deg) {
    return static_cast<int>(std::lround((deg - space.first_deg) / kLine_deg));
  };
  const EchoBox box{line(numbers[2]), line(numbers[3]), sample(numbers[0]), sample(numbers[1])};
  if (box.first_line < 0 || box.last_line >= space.lines || box.last_sample >= space.samples)
    throw SceneError("a region outside the sector: " + row);
  std::vector<BlockPlane> planes;
  for (const std::vector<float>& frame : space.frames)
    planes.push_back({.values = frame, .lines = space.lines, .samples = space.samples});
  const BoxEcho echo = boxEcho(planes, box, static_cast<std::size_t>(numbers[4]), kReach);
  fmt::print("| {} | {:.0f} | {:.1f} | {:.2f} | {:.2f} |", name, echo.mean, echo.deviation,
             kSample_mm * echo.axial_samples, kLine_deg * echo.lateral_lines);
  for (const double c : echo.tracked) fmt::print(" {:.2f}", c);
  fmt::print(" |");
  for (const double c : echo.in_place) fmt::print(" {:.2f}", c);
  fmt::print(" |\n");
}

}  // namespace

void printRegions(const std::string& regions, const std::string& loop, double mm_per_pixel,
                  const std::string& save) {
  const BeamSpace space =
      beamSpace(loop.ends_with(".toml") ? ofScene(loop) : ofVideo(loop, mm_per_pixel));
  if (!save.empty()) saveFirst(space, save);
  std::ifstream file(regions);
  std::string row;
  std::getline(file, row);  // the header
  fmt::print(
      "| region | mean | deviation | axial mm | lateral deg | tracked, 1 to 5 frames | in place "
      "|\n|---|---|---|---|---|---|---|\n");
  while (std::getline(file, row)) printRegion(space, row);
}

}  // namespace echocine::bench
