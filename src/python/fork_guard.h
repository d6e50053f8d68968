#pragma once
// Threads do not survive a fork, and a lock that one of them held stays locked in the child.

namespace echocine::python {

// Once, when the module is loaded.
void watchForks();

// Before anything is computed. Throws JobError in a child of a process that had computed before it
// forked: that child has the parent's locks and none of its threads.
void beginWork();

}  // namespace echocine::python
