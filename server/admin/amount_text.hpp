// Amounts as text for operators.
#pragma once
#include <cstdint>
#include <string>

namespace runstone {

/// Returns a count of bytes in the largest unit of which there is at least one, as in "12.3 GiB".
std::string byte_count_text(std::uint64_t bytes);

}  // namespace runstone
