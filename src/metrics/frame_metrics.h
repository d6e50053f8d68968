#pragma once
// Differences between two frames in beam space.

#include <array>
#include <span>
#include <vector>

namespace echocine {

// Grey levels x (synthetic) and y (real), 0 to 255, at samples with weights w (0: excluded), N =
// sum w.
struct FrameMetrics {
  double rms = 0;            // sqrt(sum w (x - y)^2 / N), grey levels
  double mean_absolute = 0;  // sum w |x - y| / N, grey levels
  double psnr_db = 0;        // 20 log10(255 / rms); infinite for equal frames
  double ncc = 0;   // correlation coefficient; 0 for a constant frame (1 if both are equal)
  double ssim = 0;  // structuralSimilarity()
  double mutual_information = 0;    // bits, of 32 x 32 grey levels
  double histogram_distance = 0;    // grey levels: area between the cumulative histograms
  double gradient_correlation = 0;  // gradientCorrelation()
  double weight = 0;                // N; all others are 0 if N is
};

// Averaging of frames' values over a loop.
enum class LoopMean {
  arithmetic,
  root_mean_square,  // of all samples of all frames
  psnr               // of the loop's root mean square
};

// All metrics: means, tables, files and pages follow these rows.
struct Metric {
  const char* key;     // in CSV and JSON
  const char* title;   // with its unit
  const char* column;  // on the terminal; empty: not shown
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

// Over frames with positive weight; all 0 without any.
FrameMetrics loopMetrics(std::span<const FrameMetrics> frames);

struct BeamPair {
  std::span<const float> x, y, weights;  // line-major, lines * samples
  int lines = 0, samples = 0;
};

FrameMetrics frameMetrics(const BeamPair& pair);

// metrics/structural_similarity.h over the samples; its window includes only those in the area.
double structuralSimilarity(const BeamPair& pair);

// Mean of the correlation coefficients of the derivatives across and along the beams (Penney et
// al., IEEE Trans. Med. Imaging 17(4), 1998). Central differences; a derivative without both
// neighbours in the area is omitted.
double gradientCorrelation(const BeamPair& pair);

}  // namespace echocine
