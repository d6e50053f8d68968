#pragma once
// What a caller of the library names: a scene in, frames and loops out. Everything throws
// SceneError (what was given cannot be used; messages name scene keys) or JobError (the work
// failed).

#include "core/error.h"
#include "core/monitor.h"
#include "frame/simulator.h"
#include "motion/heart/heart_scene.h"
#include "render/render.h"
#include "scene/names.h"
#include "scene/scene.h"
#include "scene/scene_reader.h"
