// Pictures that nobody watches give way to what somebody waits for.
#pragma once

namespace runstone {

/// Of the calling thread, and of those that it or a driver starts from here on: llvmpipe's would else take
/// the cores from the threads that apply and mesh. Not SCHED_IDLE: on a busy machine that starves frames for
/// seconds. Where it cannot be had all works as well, only later.
void lower_priority();

}  // namespace runstone
