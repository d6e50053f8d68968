#pragma once
// Random numbers as a hash of their purpose: independent of order and number of threads.

#include <cmath>
#include <cstdint>
#include <numbers>

namespace echocine {

// Finaliser of splitmix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators",
// OOPSLA 2014): bijective; each input bit changes about half of the output bits.
constexpr std::uint64_t mixBits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

// A hash of an ordered list of numbers, such as (seed, purpose, beat).
template <typename... Numbers>
constexpr std::uint64_t hashOf(Numbers... numbers) {
  std::uint64_t hash = 0;
  ((hash = mixBits(hash + 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(numbers))), ...);
  return hash;
}

// Uniform over (0, 1), never an end: the middle of one of 2^52 equal parts.
constexpr double uniformFromHash(std::uint64_t hash) {
  return (static_cast<double>(hash >> 12) + 0.5) * 0x1p-52;
}

// Standard normal from two hashes (Box and Muller, Ann. Math. Statist. 29(2), 610-611, 1958).
inline double normalFromHashes(std::uint64_t radius, std::uint64_t angle) {
  return std::sqrt(-2 * std::log(uniformFromHash(radius))) *
         std::cos(2 * std::numbers::pi * uniformFromHash(angle));
}

}  // namespace echocine
