#pragma once
// Threads do not survive a fork, and their locks stay locked in the child.

namespace echocine::python {

// Call once, when the module is loaded.
void watchForks();

// Call before any computation. Throws JobError in a child of a process that computed before it
// forked: the child has the parent's locks and none of its threads.
void beginWork();

}  // namespace echocine::python
