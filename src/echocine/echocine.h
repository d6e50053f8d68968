#pragma once
// The library's interface: a scene in, frames and loops out. Functions throw SceneError for
// unusable input (messages name scene keys) or JobError for a failed operation.

#include "core/error.h"
#include "core/monitor.h"
#include "frame/simulator.h"
#include "loop/loop.h"
#include "motion/heart/heart_scene.h"
#include "render/render.h"
#include "scene/names.h"
#include "scene/scene.h"
#include "scene/scene_reader.h"
