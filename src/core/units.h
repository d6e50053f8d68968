#pragma once
// Conversions between the units of scene files and SI. Inside the program every quantity is SI
// (metre, second, radian, kilogram, neper); other units appear only here.

#include <cmath>
#include <numbers>

namespace echocine {

constexpr double metresFromMillimetres(double mm) {
  return mm * 1e-3;
}
constexpr double millimetresFromMetres(double m) {
  return m * 1e3;
}
constexpr double hertzFromMegahertz(double mhz) {
  return mhz * 1e6;
}
constexpr double radiansFromDegrees(double deg) {
  return deg * (std::numbers::pi / 180.0);
}
constexpr double degreesFromRadians(double rad) {
  return rad * (180.0 / std::numbers::pi);
}
constexpr double cubicMetresFromCubicCentimetres(double cm3) {
  return cm3 * 1e-6;
}
constexpr double millilitresFromCubicMetres(double m3) {
  return m3 * 1e6;
}
constexpr double perMetreFromPerCentimetre(double per_cm) {
  return per_cm * 1e2;
}
constexpr double perCentimetreFromPerMetre(double per_m) {
  return per_m * 1e-2;
}
constexpr double metresFromMicrometres(double um) {
  return um * 1e-6;
}
// 1 cm^2/dyn = 10 Pa^-1.
constexpr double perPascalFromSquareCentimetrePerDyne(double cm2_dyn) {
  return cm2_dyn * 10.0;
}
constexpr double hertzFromBeatsPerMinute(double bpm) {
  return bpm / 60.0;
}

// Amplitude attenuation: 1 Np = 20 log10(e) dB = 8.6859 dB. Eq. 3's exp(-2 alpha l) squares the
// amplitude exp(-alpha l), so alpha is per metre of one-way path and refers to amplitude.
inline double nepersFromDecibels(double db) {
  return db * (std::numbers::ln10 / 20.0);
}
inline double decibelsFromNepers(double np) {
  return np * (20.0 / std::numbers::ln10);
}

// alpha(f) = a f^b with a in dB/(cm MHz^b), f in MHz -> Np/m.
inline double nepersPerMetre(double db_cm_mhz, double exponent, double frequency_hz) {
  return perMetreFromPerCentimetre(
      nepersFromDecibels(db_cm_mhz * std::pow(frequency_hz * 1e-6, exponent)));
}

// Decibels of an intensity ratio: 10 log10.
inline double decibelsFromIntensity(double ratio) {
  return 10.0 * std::log10(ratio);
}
inline double intensityFromDecibels(double db) {
  return std::pow(10.0, db / 10.0);
}

}  // namespace echocine
