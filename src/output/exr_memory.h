#pragma once
// A stream of OpenEXR's into memory.

#include <ImfIO.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "core/check.h"

namespace echocine {

// Collects a file in memory, so that it is hashed and written in one piece. The memory is the
// thread's own and used again: fresh pages cost as much as the encoding.
class ExrMemory : public Imf::OStream {
 public:
  ExrMemory(const std::string& name, std::vector<std::byte>& bytes)
      : OStream(name.c_str()), bytes_(bytes) {
    bytes_.clear();
  }

  void write(const char data[], int size) override {
    const auto* from = reinterpret_cast<const std::byte*>(data);
    // The library goes back once, to fill in the table of line offsets.
    const std::size_t over = std::min(bytes_.size() - position_, static_cast<std::size_t>(size));
    if (over > 0) std::memcpy(bytes_.data() + position_, from, over);
    bytes_.insert(bytes_.end(), from + over, from + size);
    position_ += static_cast<std::size_t>(size);
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override {
    CHECK_LE(position, bytes_.size());
    position_ = position;
  }

 private:
  std::vector<std::byte>& bytes_;
  std::size_t position_ = 0;
};

}  // namespace echocine
