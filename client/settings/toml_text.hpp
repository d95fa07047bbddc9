// TOML text: values as they are written into the files of this folder.
#pragma once
#include <fmt/format.h>

#include <string>
#include <string_view>

namespace runstone {

/// Returns a basic string of TOML. Requires printable text.
inline std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// Returns the shortest decimal that reads back to the same double, in a form that TOML reads as a
/// float. Requires a finite value.
inline std::string toml_float(double value) {
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

}  // namespace runstone
