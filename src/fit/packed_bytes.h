#pragma once
// Numbers and lists as bytes of this machine, for files that only this machine reads.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace echocine::fit {

class PackedBytes {
 public:
  template <typename T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* from = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), from, from + sizeof(T));
  }
  template <typename T>
  void putAll(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(static_cast<std::uint64_t>(values.size()));
    const auto* from = reinterpret_cast<const std::byte*>(values.data());
    bytes_.insert(bytes_.end(), from, from + values.size() * sizeof(T));
  }
  void putText(const std::string& text) { putAll(std::vector<char>(text.begin(), text.end())); }
  std::span<const std::byte> all() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

// Reads in the same order. After bytes that are too few, good() is false and values are empty.
class UnpackedBytes {
 public:
  explicit UnpackedBytes(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <typename T>
  T get() {
    static_assert(std::is_trivially_copyable_v<T>);
    T out{};
    if (const std::byte* from = next(sizeof(T))) std::memcpy(&out, from, sizeof(T));
    return out;
  }
  template <typename T>
  std::vector<T> getAll() {
    const auto count = get<std::uint64_t>();
    if (count > (bytes_.size() - at_) / sizeof(T)) good_ = false;
    if (!good_ || count == 0) return {};
    std::vector<T> out(static_cast<std::size_t>(count));
    std::memcpy(out.data(), next(out.size() * sizeof(T)), out.size() * sizeof(T));
    return out;
  }
  std::string getText() {
    const std::vector<char> text = getAll<char>();
    return {text.begin(), text.end()};
  }
  bool good() const { return good_; }
  bool atEnd() const { return good_ && at_ == bytes_.size(); }

 private:
  const std::byte* next(std::size_t count) {
    if (!good_ || count > bytes_.size() - at_) {
      good_ = false;
      return nullptr;
    }
    const std::byte* from = bytes_.data() + at_;
    at_ += count;
    return from;
  }
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

}  // namespace echocine::fit
