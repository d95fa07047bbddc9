#include "common/core/text.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>

namespace runstone {
namespace {

struct CharacterRange {
  std::uint32_t first, last;
};

/// Default_Ignorable_Code_Point and Bidi_Control of Unicode 15 (DerivedCoreProperties.txt,
/// PropList.txt), line and paragraph separators, and blanks that are not U+0020.
constexpr std::array<CharacterRange, 24> kUnseen = {
    {{0x00a0, 0x00a0},   {0x00ad, 0x00ad},   {0x034f, 0x034f},   {0x061c, 0x061c},
     {0x115f, 0x1160},   {0x1680, 0x1680},   {0x17b4, 0x17b5},   {0x180b, 0x180f},
     {0x2000, 0x200f},   {0x2028, 0x202f},   {0x205f, 0x206f},   {0x2800, 0x2800},
     {0x3000, 0x3000},   {0x3164, 0x3164},   {0xfe00, 0xfe0f},   {0xfeff, 0xfeff},
     {0xffa0, 0xffa0},   {0xfff0, 0xfffb},   {0xfffe, 0xffff},   {0x1bca0, 0x1bca3},
     {0x1d173, 0x1d17a}, {0xe0000, 0xe0fff}, {0xf0000, 0xfffff}, {0x100000, 0x10ffff}}};

bool is_unseen(std::uint32_t character) {
  return std::any_of(std::begin(kUnseen), std::end(kUnseen),
                     [character](const CharacterRange& range) {
                       return character >= range.first && character <= range.last;
                     });
}

}  // namespace

std::uint32_t next_character(std::string_view text, std::size_t& at) {
  const auto lead = static_cast<unsigned char>(text[at++]);
  if (lead < 0x80) return lead;
  const unsigned more = lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : 1;
  std::uint32_t character = lead & (0x3fU >> more);
  for (unsigned i = 0; i < more; ++i)
    character = character << 6 | (static_cast<unsigned char>(text[at++]) & 0x3fU);
  return character;
}

bool is_printable_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    if (lead < 0x20 || lead == 0x7f) return false;
    std::size_t length = 1;
    // Bounds of the second byte. They exclude overlong forms and surrogates.
    unsigned low = 0x80, high = 0xbf;
    if (lead >= 0x80) {
      if (lead >= 0xc2 && lead <= 0xdf) {
        length = 2;
        if (lead == 0xc2) low = 0xa0;  // the C1 controls lie below
      } else if (lead >= 0xe0 && lead <= 0xef) {
        length = 3;
        if (lead == 0xe0) low = 0xa0;
        if (lead == 0xed) high = 0x9f;
      } else if (lead >= 0xf0 && lead <= 0xf4) {
        length = 4;
        if (lead == 0xf0) low = 0x90;
        if (lead == 0xf4) high = 0x8f;
      } else {
        return false;
      }
    }
    if (text.size() - i < length) return false;
    for (std::size_t k = 1; k < length; ++k) {
      const auto byte = static_cast<unsigned char>(text[i + k]);
      if (byte < low || byte > high) return false;
      low = 0x80;
      high = 0xbf;
    }
    i += length;
  }
  return true;
}

bool is_plain_name(std::string_view text) {
  return !text.empty() && text.front() != ' ' && text.back() != ' ' && is_printable_utf8(text) &&
         text.find_first_of("\"\\") == std::string_view::npos && !has_unseen_character(text);
}

bool has_unseen_character(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    if (is_unseen(next_character(text, at))) return true;
  }
  return false;
}

std::string with_unseen_replaced(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t first = at;
    if (is_unseen(next_character(text, at))) {
      out += '?';
    } else {
      out += text.substr(first, at - first);
    }
  }
  return out;
}

std::string_view cut_utf8(std::string_view text, std::size_t bytes_max) {
  if (text.size() <= bytes_max) return text;
  std::size_t end = bytes_max;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return text.substr(0, end);
}

}  // namespace runstone
