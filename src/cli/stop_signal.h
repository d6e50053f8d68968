#pragma once
// Ctrl-C and SIGTERM as a wish to stop, which running work asks for between frames.

namespace echocine {

void listenForStop();  // from now on the signals only note the wish
bool stopWanted();

}  // namespace echocine
