// Work that nobody waits for gives way to what somebody does.
#pragma once

namespace runstone {

/// Of the calling thread, and of those that it or a library starts from here on: pictures that nobody watches, terrain
/// beside edits. Not SCHED_IDLE: on a busy machine that starves for seconds. Where it cannot be had all works as well,
/// only later.
void lower_priority();

}  // namespace runstone
