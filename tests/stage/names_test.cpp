// Names of choices, and what names of structures say.

#include "scene/names.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace echocine {
namespace {

// Each value once, each name once, in the order of the enum: nothing can read past the list.
template <typename E>
void expectWhole() {
  std::set<std::string> names;
  int expected = 0;
  for (const Named<E>& entry : NamesOf<E>::kAll) {
    EXPECT_EQ(static_cast<int>(entry.value), expected++) << entry.name;
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_STREQ(nameOf(entry.value), entry.name);
    EXPECT_EQ(valueOf<E>(entry.name), entry.value);
  }
  EXPECT_FALSE(valueOf<E>("no such name").has_value());
}

TEST(Names, AreWhole) {
  expectWhole<ProbeKind>();
  expectWhole<WarpChoice>();
  expectWhole<Interpolation>();
  expectWhole<Switch>();
  expectWhole<Effect>();
  expectWhole<Tgc>();
  expectWhole<Look>();
  expectWhole<Quality>();
  expectWhole<Spread>();
  expectWhole<BeamWidth>();
  expectWhole<TracerChoice>();
  expectWhole<InterfaceEcho>();
  expectWhole<Normals>();
  expectWhole<ExrCompression>();
  expectWhole<ExrPixel>();
  expectWhole<CineCodec>();
  expectWhole<Role>();
}

TEST(Names, EverySwitchIsOfItsEffect) {
  std::set<Effect> switched;
  for (const EffectRow& s : kEffectSwitches) EXPECT_TRUE(switched.insert(s.effect).second);
  EXPECT_FALSE(switched.contains(Effect::channel));
}

TEST(Roles, AreGuessedFromTheNamesThatLabsUse) {
  const std::pair<const char*, Role> names[] = {{"lv_cavity", Role::lv_cavity},
                                                {"lv_endo_closed", Role::lv_cavity},
                                                {"LV", Role::lv_cavity},
                                                {"Left Ventricle", Role::lv_cavity},
                                                {"LV_myocardium", Role::lv_wall},
                                                {"left-ventricular-wall", Role::lv_wall},
                                                {"rv_endo_closed", Role::rv_cavity},
                                                {"RightVentricle", Role::rv_cavity},
                                                {"la", Role::la},
                                                {"la_wall", Role::la_wall},
                                                {"left atrium", Role::la},
                                                {"RA", Role::ra},
                                                {"aorta", Role::aorta},
                                                {"aortic_wall", Role::aortic_wall},
                                                {"aortic_valve", Role::aortic_valve},
                                                {"aortic_non_coronary", Role::aortic_valve},
                                                {"pulmonary_artery", Role::pulmonary_artery},
                                                {"mitral_posterior", Role::mitral_valve},
                                                {"papillary_anterolateral", Role::papillary_muscle},
                                                {"epi", Role::lv_wall},
                                                {"pericardium", Role::pericardium},
                                                {"lung_left", Role::surroundings},
                                                {"ball", Role::none},
                                                {"salvia", Role::none}};
  for (const auto& [name, role] : names)
    EXPECT_STREQ(nameOf(guessRole(name)), nameOf(role)) << name;
}

}  // namespace
}  // namespace echocine
