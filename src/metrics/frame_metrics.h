#pragma once
// How unlike two frames in beam space are.

#include <array>
#include <span>
#include <vector>

namespace echocine {

// Greys x (synthetic) and y (real), 0 to 255, at samples with weights w (0: left out), N = sum w.
struct FrameMetrics {
  double rms = 0;            // sqrt(sum w (x - y)^2 / N), grey levels
  double mean_absolute = 0;  // sum w |x - y| / N, grey levels
  double psnr_db = 0;        // 20 log10(255 / rms); infinite for equal frames
  double ncc = 0;   // correlation coefficient; 0 when a frame is constant (1 when both equal)
  double ssim = 0;  // structuralSimilarity()
  double mutual_information = 0;    // bits, of 32 x 32 greys
  double histogram_distance = 0;    // grey levels: area between the cumulative histograms
  double gradient_correlation = 0;  // gradientCorrelation()
  double weight = 0;                // N; all others are 0 when this is
};

// How frames' values become that of a loop.
enum class LoopMean {
  arithmetic,
  root_mean_square,  // of all samples of all frames
  psnr               // of the loop's root mean square
};

// Every metric once: means, tables, files and pages follow these rows.
struct Metric {
  const char* key;     // in CSV and JSON
  const char* title;   // with its unit
  const char* column;  // on the terminal; empty: not shown there
  int decimals;
  double FrameMetrics::*value;
  LoopMean mean = LoopMean::arithmetic;
};

inline constexpr std::array kMetrics{
    Metric{"rms", "RMS difference, grey levels", "RMS", 2, &FrameMetrics::rms,
           LoopMean::root_mean_square},
    Metric{"mean_absolute", "Mean absolute difference, grey levels", "", 2,
           &FrameMetrics::mean_absolute},
    Metric{"psnr_db", "PSNR, dB", "PSNR", 2, &FrameMetrics::psnr_db, LoopMean::psnr},
    Metric{"ncc", "Normalised cross-correlation", "NCC", 3, &FrameMetrics::ncc},
    Metric{"ssim", "SSIM", "SSIM", 3, &FrameMetrics::ssim},
    Metric{"mutual_information_bits", "Mutual information, bits", "MI", 3,
           &FrameMetrics::mutual_information},
    Metric{"histogram_distance", "Histogram distance, grey levels", "", 2,
           &FrameMetrics::histogram_distance},
    Metric{"gradient_correlation", "Gradient correlation", "GC", 3,
           &FrameMetrics::gradient_correlation}};

// Of those frames that have any weight; all 0 without one.
FrameMetrics loopMetrics(std::span<const FrameMetrics> frames);

struct BeamPair {
  std::span<const float> x, y, weights;  // line-major, lines * samples
  int lines = 0, samples = 0;
};

FrameMetrics frameMetrics(const BeamPair& pair);
double rmsDifference(const BeamPair& pair);

// signal/structural_similarity.h over the samples, whose window counts those in the area only.
double structuralSimilarity(const BeamPair& pair);

// Mean of the correlation coefficients of the derivatives across and along the beams (Penney et
// al., IEEE Trans. Med. Imaging 17(4), 1998). Central differences; a derivative whose neighbours
// are not both in the area is left out.
double gradientCorrelation(const BeamPair& pair);

}  // namespace echocine
