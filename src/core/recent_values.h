#pragma once
// Values that are expensive to make, shared by all who ask for equal keys.

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace echocine {

// Keeps the values asked for last, so that users who come one after the other share them too.
// Thread-safe.
template <typename Key, typename Value>
class RecentValues {
 public:
  // most: number of values kept alive. Others live as long as their users.
  explicit RecentValues(std::size_t most) : most_(most) {}

  // The value of an equal key, or that of make(). make() returns a Value and runs outside the lock:
  // it may use threads, and threads that ask at once may make a value each; the first one counts.
  // Throws what make() throws.
  template <typename Make>
  std::shared_ptr<const Value> get(const Key& key, Make&& make) {
    if (std::shared_ptr<const Value> known = find(key)) return known;
    auto made = std::make_shared<const Value>(make());
    const std::lock_guard lock(mutex_);
    if (std::shared_ptr<const Value> known = touch(key)) return known;
    recent_.insert(recent_.begin(), {key, made});
    if (recent_.size() > most_) recent_.pop_back();
    return made;
  }

 private:
  std::shared_ptr<const Value> find(const Key& key) {
    const std::lock_guard lock(mutex_);
    return touch(key);
  }

  // Moves it to the front. Null: none. The lock is held.
  std::shared_ptr<const Value> touch(const Key& key) {
    const auto known = std::find_if(recent_.begin(), recent_.end(),
                                    [&](const auto& entry) { return entry.first == key; });
    if (known == recent_.end()) return nullptr;
    std::rotate(recent_.begin(), known, known + 1);
    return recent_.front().second;
  }

  std::size_t most_;
  std::mutex mutex_;
  std::vector<std::pair<Key, std::shared_ptr<const Value>>> recent_;  // the last asked for first
};

}  // namespace echocine
