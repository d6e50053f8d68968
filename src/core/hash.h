#pragma once
// SHA-256 of bytes, for the manifest and for comparing the input of two runs.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace echocine {

class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;

  void update(std::span<const std::byte> bytes);
  void update(std::string_view text);
  std::string hex();  // 64 digits; call once, at the end

 private:
  struct State;
  std::unique_ptr<State> state_;
};

std::string sha256Hex(std::span<const std::byte> bytes);

// Throws JobError when the file cannot be read.
std::string sha256HexOfFile(const std::filesystem::path& path);

}  // namespace echocine
