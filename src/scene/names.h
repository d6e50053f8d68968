#pragma once
// Names of all choices of a scene, defined once for the reader, the JSON of results, the study and
// messages. A new enum value needs only its row in the list of names, here or beside the enum.

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "core/check.h"
#include "scene/channel.h"
#include "scene/named.h"
#include "scene/scene.h"

namespace echocine {

template <>
struct NamesOf<WarpChoice> {
  static constexpr Named<WarpChoice> kAll[] = {{WarpChoice::automatic, "auto"},
                                               {WarpChoice::uniform, "uniform"},
                                               {WarpChoice::systole, "systole"}};
};

template <>
struct NamesOf<Switch> {
  static constexpr Named<Switch> kAll[] = {
      {Switch::automatic, "auto"}, {Switch::on, "on"}, {Switch::off, "off"}};
};

template <>
struct NamesOf<Tgc> {
  static constexpr Named<Tgc> kAll[] = {{Tgc::perfect, "perfect"},
                                        {Tgc::mean, "mean"},
                                        {Tgc::table, "table"},
                                        {Tgc::none, "none"},
                                        {Tgc::nominal, "nominal"}};
};

template <>
struct NamesOf<Look> {
  static constexpr Named<Look> kAll[] = {{Look::paper, "paper"},       {Look::clean, "clean"},
                                         {Look::scanner, "scanner"},   {Look::smooth, "smooth"},
                                         {Look::contrast, "contrast"}, {Look::sharp, "sharp"},
                                         {Look::portable, "portable"}, {Look::faint, "faint"}};
};

template <>
struct NamesOf<Quality> {
  static constexpr Named<Quality> kAll[] = {
      {Quality::good, "good"}, {Quality::medium, "medium"}, {Quality::poor, "poor"}};
};

template <>
struct NamesOf<Spread> {
  static constexpr Named<Spread> kAll[] = {{Spread::compensate, "compensate"},
                                           {Spread::keep, "keep"}};
};

template <>
struct NamesOf<BeamWidth> {
  static constexpr Named<BeamWidth> kAll[] = {{BeamWidth::focused, "focused"},
                                              {BeamWidth::profile, "profile"},
                                              {BeamWidth::fixed, "fixed"},
                                              {BeamWidth::none, "none"}};
};

template <>
struct NamesOf<Apodization> {
  static constexpr Named<Apodization> kAll[] = {{Apodization::uniform, "uniform"},
                                                {Apodization::hann, "hann"},
                                                {Apodization::hamming, "hamming"}};
};

template <>
struct NamesOf<TracerChoice> {
  static constexpr Named<TracerChoice> kAll[] = {{TracerChoice::automatic, "auto"},
                                                 {TracerChoice::slice, "slice"},
                                                 {TracerChoice::embree, "embree"}};
};

template <>
struct NamesOf<InterfaceEcho> {
  static constexpr Named<InterfaceEcho> kAll[] = {{InterfaceEcho::automatic, "auto"},
                                                  {InterfaceEcho::centre, "centre"},
                                                  {InterfaceEcho::cell, "cell"}};
};

template <>
struct NamesOf<Normals> {
  static constexpr Named<Normals> kAll[] = {
      {Normals::automatic, "auto"}, {Normals::facet, "facet"}, {Normals::smooth, "smooth"}};
};

template <>
struct NamesOf<ExrCompression> {
  static constexpr Named<ExrCompression> kAll[] = {
      {ExrCompression::none, "none"}, {ExrCompression::rle, "rle"},
      {ExrCompression::zips, "zips"}, {ExrCompression::zip, "zip"},
      {ExrCompression::piz, "piz"},   {ExrCompression::pxr24, "pxr24"}};
};

template <>
struct NamesOf<ExrPixel> {
  static constexpr Named<ExrPixel> kAll[] = {{ExrPixel::whole, "float"}, {ExrPixel::half, "half"}};
};

template <>
struct NamesOf<CineCodec> {
  static constexpr Named<CineCodec> kAll[] = {{CineCodec::mjpg, "mjpg"}, {CineCodec::ffv1, "ffv1"}};
};

template <>
struct NamesOf<Role> {
  static constexpr Named<Role> kAll[] = {{Role::none, "none"},
                                         {Role::lv_cavity, "lv_cavity"},
                                         {Role::lv_wall, "lv_wall"},
                                         {Role::rv_cavity, "rv_cavity"},
                                         {Role::rv_wall, "rv_wall"},
                                         {Role::la, "la"},
                                         {Role::la_wall, "la_wall"},
                                         {Role::ra, "ra"},
                                         {Role::ra_wall, "ra_wall"},
                                         {Role::aorta, "aorta"},
                                         {Role::aortic_wall, "aortic_wall"},
                                         {Role::pulmonary_artery, "pulmonary_artery"},
                                         {Role::pulmonary_wall, "pulmonary_wall"},
                                         {Role::mitral_valve, "mitral_valve"},
                                         {Role::aortic_valve, "aortic_valve"},
                                         {Role::tricuspid_valve, "tricuspid_valve"},
                                         {Role::pulmonary_valve, "pulmonary_valve"},
                                         {Role::papillary_muscle, "papillary_muscle"},
                                         {Role::epicardium, "epicardium"},
                                         {Role::pericardium, "pericardium"},
                                         {Role::surroundings, "surroundings"}};
};

template <typename E>
const char* nameOf(E value) {
  for (const Named<E>& entry : NamesOf<E>::kAll)
    if (entry.value == value) return entry.name;
  CHECK_EQ(static_cast<int>(value), -1);  // a value without a row above
  return "";
}

template <typename E>
std::optional<E> valueOf(std::string_view name) {
  for (const Named<E>& entry : NamesOf<E>::kAll)
    if (entry.name == name) return entry.value;
  return std::nullopt;
}

}  // namespace echocine
