#pragma once
// Units of the heart's constants.

#include <numbers>

namespace echocine::heart {

inline constexpr double kTurn = 2 * std::numbers::pi;      // rad
inline constexpr double kDegree = std::numbers::pi / 180;  // rad
inline constexpr double kMillimetre = 1e-3;                // m
inline constexpr double kMillilitre = 1e-6;                // m^3

}  // namespace echocine::heart
