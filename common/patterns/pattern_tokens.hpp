// The words, numbers and signs of the text of a pattern. Internal to the parser.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"
#include "common/patterns/pattern.hpp"

namespace runstone {

enum class PatternTokenKind : std::uint8_t {
  word,    // a keyword or a name without quotes
  quoted,  // a name
  number,
  sign,  // % , : ( ) .. or a character that no pattern has
  end,
};

struct PatternToken {
  PatternTokenKind kind = PatternTokenKind::end;
  std::string_view raw;      // as it stands in the text
  std::string name;          // of `quoted`, without the quotes
  std::int64_t number = 0;   // of `number`
  std::uint32_t column = 0;  // in characters, from 1
};

/// Returns the tokens of a text, of which the last one is `end`. Fails for a text that is too long
/// or not printable, for a number of more than nine digits, and for a name without a closing quote.
Result<std::vector<PatternToken>, PatternError> pattern_tokens(std::string_view text);

}  // namespace runstone
