// The payload of a log line: a text and fields. It is a string, because spdlog carries strings.
// Each field stands behind the text as a separator, the name of the field, another separator, and
// its value. text_of() and json_of() are the only ways to a line, and they escape everything, so no
// value from outside can break a line, forge a field or control a terminal.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace runstone {

/// Bytes of a payload that a line shows. The rest is replaced by "...".
inline constexpr std::size_t kPayloadBytesMax = 4096;

/// Return the payload with one more field. `name` is a word of our own.
std::string with_field(std::string payload, std::string_view name, std::string_view value);
std::string with_field(std::string payload, std::string_view name, std::uint64_t value);

/// Returns the payload as text: `came name="the mole" author=3`. A value with other characters than
/// letters, digits and . _ : , / + - [ ] stands in quotes. Control characters and bytes that are
/// not UTF-8 are escaped, within quotes also quotes and backslashes.
std::string text_of(std::string_view payload);

/// Returns the members of a JSON object: `"message":"came","name":"the mole","author":3`.
std::string json_of(std::string_view payload);

/// Returns a text as a JSON string with its quotes. Bytes that are not UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

}  // namespace runstone
