// The target decodes any bytes as a change of rights. A decoded change is valid and encodes to the
// same bytes, and a state can apply it and, unless it corrects the time, take it back.
#include <cstdint>
#include <variant>

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
  if (std::holds_alternative<CorrectTime>(change)) {
    // It cannot be taken back, and keeps the end of a ban within its range.
    const Restrict ban{RestrictionKind::ban, PublicKey{}, 1'000, ""};
    state.apply(ban, {1, 0, 500});
    state.apply(change, {2, 0, 0});
    RUNSTONE_ASSERT(state.find_restriction(ban.kind, ban.subject)->value.until_us > 0);
    RUNSTONE_ASSERT(!inverse_of({{ban, {1, 0, 500}}, {change, {2, 0, 0}}}, 2).has_value());
    return 0;
  }
  state.apply(change, {1, 0, 0});
  const auto inverse = inverse_of({{change, {1, 0, 0}}}, 1);
  RUNSTONE_ASSERT(inverse.has_value() && validate(*inverse).has_value());
  state.apply(*inverse, {2, 0, 0});
  RUNSTONE_ASSERT(state.boxes().empty() && state.grants().empty() && state.restrictions().empty());
  RUNSTONE_ASSERT(state.invites().empty() && !state.password().value);
  RUNSTONE_ASSERT(state.roles().size() == built_in_roles().size());
  return 0;
}
