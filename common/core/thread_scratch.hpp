// Scratch of a thread: memory that the calls of one thread use again, so that a call allocates
// little.
#pragma once
#include <optional>

namespace runstone {

/// Returns the place of this thread's scratch of a type.
template <class Scratch>
std::optional<Scratch>& thread_scratch() {
  thread_local std::optional<Scratch> scratch;
  return scratch;
}

/// Calls work(scratch) with this thread's scratch of a type. If work throws, it may have left the
/// scratch half changed. The scratch is then deleted, and the next call makes a new one. Thread: any.
template <class Scratch, class Work>
decltype(auto) with_scratch(Work&& work) {
  std::optional<Scratch>& scratch = thread_scratch<Scratch>();
  if (!scratch) scratch.emplace();
  try {
    return work(*scratch);
  } catch (...) {
    scratch.reset();
    throw;
  }
}

}  // namespace runstone
