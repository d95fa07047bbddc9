// The target folds any bytes as the name of a player. A name that no rule refuses has a folded form
// that is not empty, is printable and folds to itself. Folding never fails for well-formed text.
#include <cstdint>
#include <string_view>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"
#include "common/names/folded_name.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace runstone;
  const std::string_view name(reinterpret_cast<const char*>(data), size);
  const auto fault = name_fault(name);
  if (!is_printable_utf8(name)) {
    RUNSTONE_ASSERT(fault.has_value());
    return 0;
  }
  const std::string folded = folded_name(name);
  RUNSTONE_ASSERT(is_printable_utf8(folded));
  RUNSTONE_ASSERT(folded_name(folded) == folded);
  RUNSTONE_ASSERT(fault || !folded.empty());
  return 0;
}
