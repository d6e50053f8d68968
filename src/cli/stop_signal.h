#pragma once
// Ctrl-C, SIGTERM and SIGHUP as a request to stop, polled by running work at its checkpoints.

namespace echocine {

// From now on the signals only set a flag; one that arrives two seconds or more after the first
// ends the program immediately.
void listenForStop();
// Polled at checkpoints, from any thread.
bool stopWanted();

}  // namespace echocine
