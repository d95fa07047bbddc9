// without_exceptions: work whose exceptions become errors, for threads of std::async. A file that takes
// too much memory then ends the work, and not the program that waits for it.
#pragma once
#include <exception>
#include <new>
#include <string>

#include "common/core/result.hpp"

namespace runstone {

/// Returns f(), or why it threw, as one line that begins with `what`. Requires an f that returns
/// Result<T, std::string>.
template <class T, class F>
Result<T, std::string> without_exceptions(const std::string& what, F&& f) {
  try {
    return f();
  } catch (const std::bad_alloc&) {
    return failure(what + ": there is not enough memory for it");
  } catch (const std::exception& error) {
    return failure(what + ": " + error.what());
  }
}

}  // namespace runstone
