#pragma once
// What a frame's file gives back of what was put into it.

#include <cstddef>
#include <span>
#include <vector>

#include "scene/channel.h"

namespace echocine {

// The values of one channel, line-major, in the unit they were written in: widened to floats, the
// scale of half floats undone. Preconditions: the bytes are a file by ExrStack::encode(); the
// channel is one of its, not Channel::medium.
std::vector<float> readBack(std::span<const std::byte> file, Channel channel);

}  // namespace echocine
