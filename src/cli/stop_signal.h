#pragma once
// Ctrl-C, SIGTERM and SIGHUP as a wish to stop, which running work asks for at its checkpoints.

namespace echocine {

// From now on the signals only note the wish; one that comes two seconds or more after the first
// ends the program at once.
void listenForStop();
// From any thread.
bool stopWanted();

}  // namespace echocine
