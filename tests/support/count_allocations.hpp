// Counts the heap allocations of a test program: it replaces the global operator new, with and
// without an alignment. Include it in one file of a program. Thread: test programs are
// single-threaded unless a test starts threads; read the counts while those rest.
#pragma once
#include <atomic>
#include <cstdlib>
#include <new>

namespace runstone::test {

struct Allocations {
  std::size_t count = 0, bytes = 0;
};

namespace counting {
inline std::atomic<std::size_t> count{0}, bytes{0};
}

/// Returns the allocations since the program began.
inline Allocations allocations() { return {counting::count, counting::bytes}; }

/// Returns the allocations of a call.
template <class F>
Allocations allocations_of(F&& f) {
  const Allocations before = allocations();
  f();
  const Allocations after = allocations();
  return {after.count - before.count, after.bytes - before.bytes};
}

}  // namespace runstone::test

// Not inlined: otherwise g++ would see free() together with operator new and warn.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++runstone::test::counting::count;
  runstone::test::counting::bytes += size;
  return std::malloc(size == 0 ? 1 : size);
}
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* p = operator new(size, std::nothrow)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t align,
                                     const std::nothrow_t&) noexcept {
  ++runstone::test::counting::count;
  runstone::test::counting::bytes += size;
  const auto step = static_cast<std::size_t>(align);
  return std::aligned_alloc(step, (size + step - 1) / step * step);
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t align) {
  if (void* p = operator new(size, align, std::nothrow)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}
