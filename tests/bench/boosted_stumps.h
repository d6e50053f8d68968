#pragma once
// A boosted classifier of rows of numbers: a sum of stumps, each a threshold of one number.

#include <cstddef>
#include <vector>

namespace echocine::bench {

// AdaBoost (Freund and Schapire, J. Comput. Syst. Sci. 55, 119-139, 1997). Both classes have the
// same total weight.
class BoostedStumps {
 public:
  using Row = std::vector<double>;

  // Precondition: rows of equal length, none empty.
  BoostedStumps(const std::vector<Row>& positive, const std::vector<Row>& negative, int rounds);

  double of(const Row& x) const;  // larger: more like the positive rows
  // Sum of the weights of the stumps of each number, over their sum.
  std::vector<double> shares() const;

 private:
  struct Stump {
    std::size_t number = 0;
    double threshold = 0, weight = 0;  // weight < 0: negative above the threshold
  };
  std::vector<Stump> stumps_;
  std::size_t numbers_;
};

}  // namespace echocine::bench
