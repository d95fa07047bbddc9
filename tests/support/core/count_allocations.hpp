// A counter of the heap allocations of a program. A program that calls allocations() links a global
// operator new that counts (with and without an alignment); other programs keep the standard one.
// Thread: the counters are atomic. Read them while no thread allocates.
#pragma once
#include <cstddef>

namespace runstone::test {

struct Allocations {
  std::size_t count = 0, bytes = 0;
};

/// Returns the allocations since the program began.
Allocations allocations();

/// Returns the allocations during a call of `f`.
template <class F>
Allocations allocations_of(F&& f) {
  const Allocations before = allocations();
  f();
  const Allocations after = allocations();
  return {after.count - before.count, after.bytes - before.bytes};
}

}  // namespace runstone::test
