// Handle: the base of the objects behind the opaque pointers of runstone.h. It begins with a number
// that tells the kinds apart, so that a handle of another kind, and most handles that were freed,
// are refused and not used.
#pragma once
#include <cstdint>
#include <memory>
#include <utility>

#include "bindings/c/refusal.hpp"

namespace runstone::c_interface {

/// `Kind` is four letters, as a number.
template <std::uint32_t Kind>
class Handle {
 public:
  Handle() = default;
  Handle(const Handle&) {}
  Handle& operator=(const Handle&) = delete;
  ~Handle() { tag_ = 0; }
  bool is_alive() const { return tag_ == Kind; }

 private:
  // Volatile, because a compiler may leave out what a destructor writes.
  volatile std::uint32_t tag_ = Kind;
};

/// Returns the object of a handle. Refuses NULL, another kind and what was freed.
template <class Object>
Object& live(Object* handle, const char* name) {
  given(handle, name);
  if (!handle->is_alive())
    refuse(RUNSTONE_BAD_HANDLE, name, "is a handle of another kind, or was freed");
  return *handle;
}

/// Returns where a new handle goes, which is NULL until the call succeeds.
template <class Object>
Object*& output(Object** out, const char* name) {
  given(out, name) = nullptr;
  return *out;
}

/// Makes an object for a handle.
template <class Object, class... Arguments>
void create(Object** out, Arguments&&... arguments) {
  *out = std::make_unique<Object>(std::forward<Arguments>(arguments)...).release();
}

/// Frees the object of a handle, if there is one.
template <class Object>
runstone_status free_handle(Object* handle, const char* name) {
  return answer([&] {
    if (handle == nullptr) return;
    const std::unique_ptr<Object> freed(&live(handle, name));
  });
}

}  // namespace runstone::c_interface
