#pragma once
// Ranges of a scene's numbers: wider than anything physical, and narrow enough that products of a
// few stay finite. Our choice throughout.

#include "scene/toml_table.h"

namespace echocine::ranges {

inline constexpr NumberRange kSector_deg{.lo = 0.001, .hi = 180};
inline constexpr NumberRange kExtent_mm{.lo = 0.001, .hi = 1e4};  // width, depth, apertures, beam
inline constexpr NumberRange kNearEnd_mm{.lo = 0, .hi = 1e4};
inline constexpr NumberRange kRadius_mm{.lo = 0.001, .hi = 1e6};  // of a face; of a focus
inline constexpr NumberRange kBandwidth{.lo = 0.01, .hi = 2};
inline constexpr NumberRange kUnitVolume_cm3{.lo = 1e-12, .hi = 1e12};
inline constexpr NumberRange kReflectionGain{.lo = 0, .hi = 1e6};
inline constexpr NumberRange kCoherentShare{.lo = 0};
inline constexpr NumberRange kDensity_kg_m3{.lo = 1e-3, .hi = 1e5};  // air 1.2, osmium 22590
inline constexpr NumberRange kSoundSpeed_m_s{.lo = 1, .hi = 1e5};    // rubber 40, diamond 18000
inline constexpr NumberRange kAttenuation_db_cm_mhz{.lo = 0, .hi = 1e6};
inline constexpr NumberRange kBackscatter_per_cm_sr{.lo = 0, .hi = 1e9};
inline constexpr NumberRange kCellRadius_um{.lo = 1e-6, .hi = 1e6};
inline constexpr NumberRange kCompressibility_cm2_dyn{.lo = 1e-18, .hi = 1e-3};  // water 5e-11
inline constexpr NumberRange kCorrelationLength_um{.lo = 0, .hi = 1e9};
inline constexpr NumberRange kDynamicRange_db{.lo = 0.01, .hi = 1000};
inline constexpr NumberRange kReferenceIntensity{.lo = 1e-37, .hi = 1e37};  // floats
inline constexpr NumberRange kFNumber{.lo = 0, .hi = 10};
inline constexpr NumberRange kGamma{.lo = 0.01, .hi = 100};
inline constexpr NumberRange kGreyToe{.lo = 0, .hi = 0.3}, kGreyShoulder{.lo = 0, .hi = 0.4};
inline constexpr NumberRange kEdge{.lo = 0, .hi = 4};
inline constexpr NumberRange kToleranceLines{.lo = 0, .hi = 1e6};
inline constexpr NumberRange kTolerance_db{.lo = 1e-6, .hi = 1000};
inline constexpr NumberRange kLevel_db{.lo = -200, .hi = 60};  // of an artefact
inline constexpr NumberRange kLoss_db{.lo = 0, .hi = 200};
inline constexpr NumberRange kPictureGain_db{.lo = -100, .hi = 100};
inline constexpr NumberRange kArtefactLength_mm{.lo = 0.01, .hi = 1e4};
// Height of the ridges, much less than half a ventricle, and their spacing. Our choice.
inline constexpr NumberRange kTrabeculae_mm{.lo = 0, .hi = 4};
inline constexpr NumberRange kLeaflet_mm{.lo = 0, .hi = 10};
inline constexpr NumberRange kChordae_mm{.lo = 0, .hi = 5};
inline constexpr NumberRange kAnnulus_mm{.lo = 0, .hi = 10};
inline constexpr NumberRange kAnnulus_db{.lo = -40, .hi = 40};
inline constexpr NumberRange kTrabeculaeScale_mm{.lo = 0.5, .hi = 50};
inline constexpr NumberRange kArtefactWidth_deg{.lo = 0.01, .hi = 180};
inline constexpr NumberRange kWindowOffset_mm{.lo = -1e4, .hi = 1e4};
inline constexpr NumberRange kHeterogeneity_db{.lo = 0, .hi = 20};
inline constexpr NumberRange kHelix_deg{.lo = 0, .hi = 90};
inline constexpr NumberRange kNominalGain_db_cm_mhz{.lo = 0, .hi = 5};
inline constexpr NumberRange kPersistence{.lo = 0, .hi = 0.8};
inline constexpr int kMostLines = 65536;  // of a probe; our choice
inline constexpr NumberRange kRollingShare{.lo = 0.001, .hi = 1};
inline constexpr NumberRange kHeartRates_bpm{.lo = 1, .hi = 1000};
inline constexpr NumberRange kBeats{.lo = 1e-6, .hi = 1e6};

inline constexpr NumberRange kTilt_deg{.lo = -90, .hi = 90};
inline constexpr NumberRange kRotate_deg{.lo = -360, .hi = 360};
inline constexpr double kMostShift_mm = 1000;  // of a probe, from its view's standard place

inline constexpr NumberRange kMeshScale{.lo = 1e-6, .hi = 1e6};
inline constexpr double kMostOffset_mm = 1e7;  // of meshes
// Between keyframes: from 4096 of a beat at 1000 per minute (0.015 ms) to two at 1 per minute (30
// s).
inline constexpr NumberRange kKeyframeInterval_ms{.lo = 0.01, .hi = 30000};

// A coordinate in mesh units: its cube is still a float.
inline constexpr double kMostCoordinate = 1e9;

// Keyframes closer than this have no motion between them.
inline constexpr double kLeastPhaseStep = 1e-6;

// Largest number of keyframes of a structure: a beat at 1000 frames per second and 15 bpm.
inline constexpr int kMostKeyframes = 4096;

}  // namespace echocine::ranges
