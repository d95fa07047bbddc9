// The low priority of background work, for processor and disk.
#pragma once

namespace runstone {

/// Lowers the priority of the calling thread, and of threads that it or a library starts
/// afterwards, to nice 10. It is for work that must not delay edits, such as off-screen frames and
/// terrain. SCHED_IDLE would be too low: on a busy machine such threads starve for seconds. A
/// failure is ignored.
void lower_priority();

/// Lowers the priority of the disk accesses of the calling thread, and of threads that it starts
/// afterwards, to the lowest one of the class best-effort. It has an effect only where the disk's
/// scheduler knows priorities. The class idle would be too low: on a busy disk it starves. A
/// failure is ignored.
void lower_disk_priority();

}  // namespace runstone
