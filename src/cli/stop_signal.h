#pragma once
// Ctrl-C, SIGTERM and SIGHUP as a wish to stop, which running work asks for between frames.

namespace echocine {

// From now on the signals only note the wish; one that comes two seconds or more after the first
// ends the program at once.
void listenForStop();
// Asked between frames, from any thread.
bool stopWanted();

}  // namespace echocine
