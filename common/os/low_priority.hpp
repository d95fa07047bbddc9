// The low priority of background work.
#pragma once

namespace runstone {

/// Lowers the priority of the calling thread, and of threads that it or a library starts
/// afterwards, to nice 10. It is for work that must not delay edits, such as off-screen frames and
/// terrain. SCHED_IDLE would be too low: on a busy machine such threads starve for seconds. A
/// failure is ignored.
void lower_priority();

}  // namespace runstone
