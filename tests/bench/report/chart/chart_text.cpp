#include "tests/bench/report/chart/chart_text.hpp"

#include <cstdint>

namespace runstone::bench::chart {
namespace {

constexpr std::uint32_t kReplacement = 0xFFFD;
constexpr std::string_view kReplacementBytes = "\xEF\xBF\xBD";
constexpr std::string_view kEllipsis = "\xE2\x80\xA6";

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
};

/// Returns the first character of a text that is not empty; kReplacement for one byte that is no
/// UTF-8.
Character first_of(std::string_view text) {
  const auto byte = [&](std::size_t at) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text[at]));
  };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || bytes > text.size()) return {kReplacement, 1};
  std::uint32_t code = lead & (0xFFU >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return {kReplacement, 1};
    code = code << 6 | (byte(i) & 0x3F);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code < 0xE000;
  if (code < kLeast[bytes] || code > 0x10FFFF || is_surrogate) return {kReplacement, 1};
  return {code, bytes};
}

bool is_forbidden(std::uint32_t code) {
  return (code < 0x20 && code != '\t' && code != '\n' && code != '\r') || code == 0xFFFE ||
         code == 0xFFFF || code == kReplacement;
}

/// Returns a width in parts of the font size.
double code_width(std::uint32_t code) {
  constexpr std::string_view kThin = "iljI.,:;'|!";
  constexpr std::string_view kSlim = "frt()[]/-\" ";
  constexpr std::string_view kWide = "mwMW@%+=<>";
  if (code >= 0x2E80) return 1.05;  // ideographs and signs
  if (code >= 0x80) return 0.68;
  const char c = static_cast<char>(code);
  if (kThin.find(c) != std::string_view::npos) return 0.32;
  if (kSlim.find(c) != std::string_view::npos) return 0.41;
  if (kWide.find(c) != std::string_view::npos) return 0.92;
  if (c >= 'A' && c <= 'Z') return 0.71;
  return 0.63;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const Character character = first_of(text);
    if (is_forbidden(character.code)) {
      out += kReplacementBytes;
    } else if (character.code == '&') {
      out += "&amp;";
    } else if (character.code == '<') {
      out += "&lt;";
    } else if (character.code == '>') {
      out += "&gt;";
    } else if (character.code == '"') {
      out += "&quot;";
    } else if (character.code == '\'') {
      out += "&#39;";
    } else {
      out += text.substr(0, character.bytes);
    }
    text.remove_prefix(character.bytes);
  }
  return out;
}

double width_of(std::string_view text, double size) {
  double out = 0;
  while (!text.empty()) {
    const Character character = first_of(text);
    out += code_width(character.code);
    text.remove_prefix(character.bytes);
  }
  return out * size;
}

std::string shortened(std::string_view text, double size, double width) {
  if (width_of(text, size) <= width) return std::string(text);
  const double room = width - width_of(kEllipsis, size);
  std::size_t kept = 0;
  double used = 0;
  while (kept < text.size()) {
    const Character character = first_of(text.substr(kept));
    used += code_width(character.code) * size;
    if (used > room) break;
    kept += character.bytes;
  }
  while (kept > 0 && text[kept - 1] == ' ') --kept;
  return std::string(text.substr(0, kept)) + std::string(kEllipsis);
}

}  // namespace runstone::bench::chart
