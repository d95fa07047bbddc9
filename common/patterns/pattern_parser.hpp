// The parser of patterns (pattern.hpp). It reads bytes that anybody may have typed: length, nesting
// and numbers are bounded. Grammar, in which words in capitals are rules:
//
//   PATTERN  = MIX [ "where" FILTER ]
//   MIX      = PARTS | "noise" SIZE ":" PARTS | ("y" | "distance") RANGE ":" PART "," PART ...
//   PARTS    = [ WEIGHT "%" ] PART { "," [ WEIGHT "%" ] PART }    all parts have a weight, or none
//   PART     = NAME | "(" MIX ")"
//   FILTER   = ALL { "or" ALL }
//   ALL      = ONE { "and" ONE }
//   ONE      = "not" ONE | "(" FILTER ")" | ("is" | "on" | "under" | "beside") NAME { "or" NAME }
//            | "exposed" | "solid" | ("above" | "below") NUMBER | "noise" PERCENT "%" [ SIZE ]
//   RANGE    = NUMBER ".." NUMBER
//
// A name begins with a letter or an underscore and goes on with these, digits and the characters
// : - . / ~. Any other name, and one that is a keyword, stands in quotes, in which a backslash
// precedes a quote and a backslash.
#pragma once
#include <string_view>

#include "common/core/result.hpp"
#include "common/patterns/pattern.hpp"

namespace runstone {

/// Fails with the first mistake: its column, what stands there and what was expected. The canonical
/// text of the result has at most kPatternBytesMax bytes, too. Cost: O(bytes).
Result<Pattern, PatternError> parse_pattern(std::string_view text);
Result<Mix, PatternError> parse_mix(std::string_view text);
Result<VoxelFilter, PatternError> parse_filter(std::string_view text);

}  // namespace runstone
