// Versioned structs: structs of runstone.h that begin with their size, so that fields can be added at
// their end.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "bindings/c/refusal.hpp"

namespace runstone::c_interface {

/// The size of a struct in the first version of the interface.
template <class Struct>
inline constexpr std::size_t kFirstSize = sizeof(Struct);
template <>
inline constexpr std::size_t kFirstSize<runstone_quad_fields> =
    offsetof(runstone_quad_fields, face);

/// Refuses a struct that is smaller than in the first version of the interface.
template <class Struct>
Struct& versioned(Struct* pointer, const char* name) {
  static_assert(std::is_trivially_copyable_v<Struct> && offsetof(Struct, struct_size) == 0);
  given(pointer, name);
  if (pointer->struct_size < kFirstSize<Struct>)
    refuse(RUNSTONE_BAD_ARGUMENT, name, "has a struct_size smaller than the struct");
  return *pointer;
}

/// Fills a struct of the caller, whose size stays. Requires versioned(). A field that is added later
/// is written only if the caller's struct has it.
template <class Struct>
void fill_versioned(Struct& out, Struct value) {
  value.struct_size = out.struct_size;
  std::memcpy(&out, &value, std::min<std::size_t>(out.struct_size, sizeof value));
}

}  // namespace runstone::c_interface
