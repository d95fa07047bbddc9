// Refusal: how a call of the C interface fails. A call checks its arguments in order and refuses the
// first bad one: refuse() keeps the words for runstone_last_error() and throws. answer() is around
// each call and turns every exception into a status, so that none leaves the library. Exceptions
// keep the calls short; a refused argument is a mistake of the caller, so it need not be fast.
#pragma once
#include <exception>
#include <new>

#include "bindings/c/runstone.h"
#include "common/core/result.hpp"

namespace runstone::c_interface {

/// The status of a call that was refused. The words are kept before it is thrown.
struct RefusedCall {
  runstone_status status;
};

/// Keeps the words of a refusal for this thread, as printf() formats them, and returns `status`.
/// Longer words than 255 bytes are cut. Allocates nothing.
runstone_status keep_words(runstone_status status, const char* format, ...)
    __attribute__((format(printf, 2, 3)));
/// Returns the words of the thread's last refusal.
const char* kept_words();

/// Refuses a call. `name` is the parameter, `why` what is wrong with it.
[[noreturn]] void refuse(runstone_status status, const char* name, const char* why);
/// Refuses a parameter with an error of the library.
[[noreturn]] void refuse(const char* name, const Error& error);

/// Does `work` and returns RUNSTONE_OK, or why it failed.
template <class F>
runstone_status answer(F&& work) noexcept {
  try {
    work();
    return RUNSTONE_OK;
  } catch (const RefusedCall& refusal) {
    return refusal.status;
  } catch (const std::bad_alloc&) {
    return keep_words(RUNSTONE_NO_MEMORY, "there is not enough memory for the call");
  } catch (const std::exception& error) {
    return keep_words(RUNSTONE_INTERNAL, "a defect of the library: %s", error.what());
  } catch (...) {
    return keep_words(RUNSTONE_INTERNAL, "a defect of the library");
  }
}

/// Refuses a null pointer.
template <class T>
T& given(T* pointer, const char* name) {
  if (pointer == nullptr) refuse(RUNSTONE_BAD_ARGUMENT, name, "is NULL");
  return *pointer;
}

/// Refuses a number above `max`.
template <class T>
void check_at_most(T value, T max, const char* name, const char* why) {
  if (value > max) refuse(RUNSTONE_BAD_ARGUMENT, name, why);
}

}  // namespace runstone::c_interface
