// Ranges of network addresses as text.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "common/rights/address_range.hpp"

namespace runstone {

struct ParsedRange {
  AddressRange range;
  bool is_widened = false;  // the text was a single IPv6 address, which means its /64
};

/// Parses "192.0.2.7", "192.0.2.0/24", "2001:db8::1" or "2001:db8::/32". Bits behind the prefix are
/// set to 0. A single IPv6 address means its /64. Returns nullopt if the text is no address and no
/// address with "/" after it. Fails if the length of the prefix is no number from 0 to 32, or for
/// IPv6 from 0 to 64.
std::optional<Result<ParsedRange, std::string>> parse_address_range(std::string_view text);

/// Returns text that parse_address_range() reads, such as "192.0.2.7", "192.0.2.0/24" or
/// "2001:db8::/64". Requires a canonical range.
std::string text_of(const AddressRange& range);

}  // namespace runstone
