// What the patches beside this file add is there by its name.

#include <type_traits>

#include "scene/key_field.h"
#include "scene/scene.h"

#ifdef ADDED_PROBE_KIND
static_assert(echocine::layoutOf(echocine::ProbeKind::microconvex).curved_face);
#endif
#ifdef ADDED_EFFECT
static_assert(echocine::ArtefactSettings{}.edge_boost_db == 6);
static_assert([] {
  for (const echocine::EffectRow& row : echocine::kEffects)
    if (row.effect == echocine::Effect::edge_boost) return true;
  return false;
}());
#endif
#ifdef ADDED_INTERPOLATION_KIND
static_assert(echocine::NamesOf<echocine::Interpolation>::kAll[5].value ==
              echocine::Interpolation::cosine);
#endif
