#pragma once
// A sparse square matrix by rows, whose members ascend.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echocine {

template <typename Number>
class SparseRows {
 public:
  // (A x)_n = sum_i values[i] x[members[i]].
  struct Row {
    std::span<const std::uint32_t> members;
    std::span<const Number> values;
  };

  SparseRows() = default;
  // Rounded.
  template <typename Other>
  explicit SparseRows(const SparseRows<Other>& other)
      : starts_(other.starts_), members_(other.members_) {
    values_.reserve(other.values_.size());
    for (const Other value : other.values_) values_.push_back(static_cast<Number>(value));
  }

  void reserve(std::size_t rows, std::size_t members) {
    starts_.reserve(rows + 1);
    members_.reserve(members);
    values_.reserve(members);
  }
  void add(std::uint32_t member, double value) {
    members_.push_back(member);
    values_.push_back(static_cast<Number>(value));
  }
  // A whole row.
  void add(const Row& row) {
    members_.insert(members_.end(), row.members.begin(), row.members.end());
    values_.insert(values_.end(), row.values.begin(), row.values.end());
    endRow();
  }
  void endRow() { starts_.push_back(static_cast<std::uint32_t>(members_.size())); }

  std::size_t size() const { return starts_.size() - 1; }
  std::size_t memberCount() const { return members_.size(); }
  Row operator[](std::size_t n) const {
    const std::size_t first = starts_[n], count = starts_[n + 1] - first;
    return {{members_.data() + first, count}, {values_.data() + first, count}};
  }

 private:
  template <typename>
  friend class SparseRows;
  std::vector<std::uint32_t> starts_{0}, members_;
  std::vector<Number> values_;
};

}  // namespace echocine
