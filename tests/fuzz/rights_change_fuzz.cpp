// The target decodes any bytes as a change of rights. A decoded change is valid and encodes to the
// same bytes, and a state can apply it and take it back.
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/rights/change_rules.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace runstone;
  const ByteView bytes(data, size);
  ByteReader in(bytes);
  const RightsChange change = read_rights_change(in);
  if (!in.ok()) return 0;
  RUNSTONE_ASSERT(validate(change).has_value());
  Bytes again;
  encode(change, again);
  RUNSTONE_ASSERT(again == Bytes(bytes.begin(), bytes.end()));
  RUNSTONE_ASSERT(again.size() <= kRightsChangeBytesMax);
  RightsState state;
  state.apply(change, {1, 0, 0});
  const auto inverse = inverse_of({{change, {1, 0, 0}}}, 1);
  RUNSTONE_ASSERT(inverse.has_value() && validate(*inverse).has_value());
  state.apply(*inverse, {2, 0, 0});
  RUNSTONE_ASSERT(state.boxes().empty() && state.grants().empty() && state.restrictions().empty());
  RUNSTONE_ASSERT(state.invites().empty() && !state.password().value);
  RUNSTONE_ASSERT(state.roles().size() == built_in_roles().size());
  return 0;
}
