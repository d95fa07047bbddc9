// The target reads any bytes as a pattern. A mistake is a printable line whose column lies in the
// text or just behind it; a pattern is written as a text that is read back to the same pattern.
#include <cstdint>
#include <string_view>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"
#include "common/patterns/pattern_parser.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace runstone;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto pattern = parse_pattern(text);
  if (!pattern) {
    RUNSTONE_ASSERT(is_printable_utf8(pattern.error().message()));
    RUNSTONE_ASSERT(pattern.error().column >= 1 && pattern.error().column <= size + 1);
    return 0;
  }
  const std::string written = text_of(*pattern);
  const auto again = parse_pattern(written);
  RUNSTONE_ASSERT(again && *again == *pattern && text_of(*again) == written);
  RUNSTONE_ASSERT(!chips_of(*pattern).empty());
  return 0;
}
