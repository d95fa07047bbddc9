// Buffers of the caller: sizes are asked first, and a buffer that is too small is not written.
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>

#include "bindings/c/refusal.hpp"

namespace runstone::c_interface {

/// Writes `needed` to *count. Returns false if `capacity` is 0. Refuses a smaller `capacity` than
/// `needed`. Otherwise returns true.
template <class T>
bool has_room(const T* out, std::size_t capacity, std::size_t needed, std::size_t* count) {
  given(count, "count") = needed;
  if (capacity == 0) return false;
  given(out, "out");
  if (capacity < needed)
    refuse(RUNSTONE_BUFFER_TOO_SMALL, "capacity", "is smaller than the number of elements");
  return true;
}

/// Copies elements to a buffer of the caller.
template <class T, class From>
void write_elements(std::span<const From> from, T* out, std::size_t capacity, std::size_t* count) {
  if (has_room(out, capacity, from.size(), count)) std::copy(from.begin(), from.end(), out);
}

/// Returns elements that the caller gives. NULL is allowed if there are none.
template <class T>
std::span<const T> elements(const T* from, std::size_t count, const char* name) {
  if (count == 0) return {};
  return {&given(from, name), count};
}

}  // namespace runstone::c_interface
