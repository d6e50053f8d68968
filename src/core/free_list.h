#pragma once
// Working memory that is expensive to make, lent to one user at a time and used again.

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace echocine {

// Grows to the largest number of objects in use at once, and keeps them until its end. Thread-safe.
template <typename T>
class FreeList {
 public:
  // A free object, or that of make(), which returns a std::unique_ptr<T> and runs outside the lock.
  // It is in the state in which its last user left it, and returns to the list with the last copy
  // of the pointer. Precondition: no pointer outlives the list. Throws what make() throws.
  template <typename Make>
  std::shared_ptr<T> borrow(Make&& make) {
    std::unique_ptr<T> lent = takeFree();
    if (!lent) {
      lent = make();
      const std::lock_guard lock(mutex_);
      free_.reserve(++made_);  // so that a return needs no memory
    }
    return {lent.release(), [this](T* used) {
              const std::lock_guard lock(mutex_);
              free_.emplace_back(used);
            }};
  }

 private:
  std::unique_ptr<T> takeFree() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return nullptr;
    std::unique_ptr<T> lent = std::move(free_.back());
    free_.pop_back();
    return lent;
  }

  std::mutex mutex_;
  std::size_t made_ = 0;
  std::vector<std::unique_ptr<T>> free_;
};

}  // namespace echocine
