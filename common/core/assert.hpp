// Assertions for bugs. Bad input is no bug: it returns a Result.
//   - RUNSTONE_ASSERT stays on in every build. It serves work done once per message, edit or tick.
//   - RUNSTONE_DASSERT serves inner loops. Optimised builds leave it out.
#pragma once

namespace runstone {
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line);
}  // namespace runstone

#define RUNSTONE_ASSERT(expression)    \
  ((expression) ? static_cast<void>(0) \
                : ::runstone::assertion_failed(#expression, __FILE__, __LINE__))

#ifdef NDEBUG
#define RUNSTONE_DASSERT(expression) static_cast<void>(0)
#else
#define RUNSTONE_DASSERT(expression) RUNSTONE_ASSERT(expression)
#endif
