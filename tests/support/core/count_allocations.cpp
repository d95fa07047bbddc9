#include "tests/support/core/count_allocations.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace runstone::test {
namespace {

std::atomic<std::size_t> allocated_blocks{0}, allocated_bytes{0};

}  // namespace

Allocations allocations() { return {allocated_blocks, allocated_bytes}; }

static void count_allocation(std::size_t size) {
  ++allocated_blocks;
  allocated_bytes += size;
}

}  // namespace runstone::test

// The function is not inlined, because g++ would warn about free() of memory from operator new.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  runstone::test::count_allocation(size);
  return std::malloc(size == 0 ? 1 : size);
}
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* p = operator new(size, std::nothrow)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t align,
                                     const std::nothrow_t&) noexcept {
  runstone::test::count_allocation(size);
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
