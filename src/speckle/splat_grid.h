#pragma once
// Splats on a grid of rows (across the lines) and nodes (along them). The grid's spacing follows
// the point spread function and not the picture, so the cost of the sums does not grow with their
// width.
//
// Scatterer s adds to the four by four nodes about it, with B-spline weights a_m across and b_n
// along (spline_taps.h):
//   U_mn = sum_s A_s c_s e_s a_m b_n          A_s^2: the picture at the scatterer's place
//   g = sum_mn h_m k_n U_mn                   h, k: taps of lateral_taps.h and axial_sums.h
// The power across the rows is exact: (sum_m a_m h_m)^2 has terms at rows, and between two rows,
//   P_mn = sum_s A_s^2 e_s^2 (a_m^2 + 2 q a_(m-1) a_(m+1)) b_n,
//   Q_mn = sum_s A_s^2 e_s^2 (2 a_m a_(m+1) + 2 q^2 a_(m-1) a_(m+2)) b_n,
//   w = sum_mn (h_m^2 P_mn + h_m h_(m+1) Q_mn) H_n,
// with q = h_(m-1) h_(m+1) / h_m^2, which a Gaussian has everywhere. H are the axial taps of power.

#include <span>
#include <vector>

#include "core/beam_plane.h"
#include "core/lanes.h"
#include "speckle/beam_view.h"
#include "speckle/splat_lists.h"
#include "speckle/spline_taps.h"

namespace echocine {

struct alignas(64) CacheLine {
  float floats[16];
};

// A grid relative to lines or samples. One of the two is 1, or there are two rows for three lines.
struct GridSpacing {
  int finer = 1;    // so many nodes or rows
  int coarser = 1;  // for so many samples or lines
  double nodes(double samples) const { return samples * finer / coarser; }
};

// Four floats of a node: real and imaginary part of U, P and Q.
inline constexpr std::ptrdiff_t kNodeFloats = 4;

class SplatGrid {
 public:
  SplatGrid(const Probe& probe, const PointSpread& spread, const BeamView& view);

  // Memory of one frame in progress.
  struct Rows {
    std::vector<CacheLine> ring;
    std::vector<float> amplitudes;  // roots of the picture, of four lines
    int next_row = 0;               // the first that is not yet cleared
  };

  const GridSpacing& across() const { return across_; }
  const GridSpacing& along() const { return along_; }
  std::ptrdiff_t nodes() const { return nodes_; }    // from the first sample to behind the last
  std::ptrdiff_t stride() const { return stride_; }  // floats of a row, a multiple of 16
  // Nodes before the first sample's and behind the last one's.
  std::ptrdiff_t margin() const { return margin_; }
  // Sigma across the lines by sample, in rows.
  const std::vector<double>& deviations() const { return deviations_; }
  bool even() const { return even_; }  // the same sigma at all samples
  // Sigma along a line at a sample, in samples, and the largest of all.
  double axialSamples(int sample) const { return axial_samples_ * widenings_[sample]; }
  double mostAxialSamples() const;

  // rows: the number that one line's sum takes. Lines are added in ascending order from `first_row`
  // on.
  void start(int first_row, int rows_in_use, Rows& rows) const;
  // The picture's line, whose root is kept until three more are set.
  void setAmplitudes(int line, const float* intensities, Rows& rows) const;
  // Precondition: the amplitudes of the line and its neighbours are set.
  void add(std::span<const Splat> splats, int line, Rows& rows) const;
  // Clears the rows up to here that no line has reached.
  void clearUpTo(int row, Rows& rows) const;
  float* row(Rows& rows, int number) const;  // its node 0

  // The last row before or at the beginning of a line's share.
  int rowBefore(int line) const;

 private:
  struct LineSteps;

  template <bool even>
  void addAll(std::span<const Splat> splats, int line, Rows& rows) const;
  void setAcross(std::vector<double> lines);
  void setWeights();
  float* amplitudesOf(Rows& rows, int line) const;

  int lines_, samples_;
  double axial_samples_;           // without downshift
  std::vector<double> widenings_;  // by sample
  GridSpacing across_, along_;
  int up_ = 0, down_ = 0;  // of a sample's step to a node's: bits
  std::ptrdiff_t nodes_ = 0, margin_ = 0, stride_ = 0;
  bool even_ = false;
  std::vector<double> deviations_;
  std::vector<CacheLine> axial_;  // by step: the weight of each of four nodes, four times
  // By step: a node's factors of four rows, then those of q, q^2; if even, both together, twice.
  std::vector<CacheLine> lateral_;
  std::vector<Floats4> couplings_;  // 0, 0, q, q^2 by sample, or one for all
};

}  // namespace echocine
