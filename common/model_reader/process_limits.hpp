// Limits that runstone-read-model sets itself before it opens a file. A parser of foreign files may have
// faults that a file takes over the process with, so the process gives up what it does not need.
// Thread: the only one of the process.
#pragma once
#include <cstdint>
#include <string>

#include "common/core/result.hpp"

namespace runstone {

struct ProcessLimits {
  std::uint64_t memory_bytes = 0;  // of its address space
  std::uint32_t cpu_s = 0;  // of its processor time; then SIGXCPU, and SIGKILL a second later
};

/// Bounds memory, processor time and open files of this process. From then on it writes no regular file
/// and no core dump, and no program that it starts gets more rights. The error is one line. With
/// AddressSanitizer memory is not bounded, because it reserves terabytes.
Result<void, std::string> limit_process(const ProcessLimits& limits);

/// Lets the kernel refuse all system calls of this process but those that reading files and computing
/// need: no socket, no program, no new process, no signal to others. A refused call fails with EPERM.
/// Does nothing on processors other than x86-64 and AArch64. The error is one line. Requires
/// limit_process().
Result<void, std::string> refuse_other_calls();

}  // namespace runstone
