#include "server/names/name_skeleton.hpp"

#include <unicode/uchar.h>
#include <unicode/uspoof.h>
#include <unicode/ustring.h>
#include <unicode/utf8.h>

#include <array>
#include <cstdint>
#include <functional>
#include <utility>

#include "common/core/assert.hpp"
#include "common/names/folded_name.hpp"

namespace runstone {
namespace {

/// The small capitals and the letters that they stand for. Unicode's table of confusable characters
/// has only those that look like another small letter.
constexpr std::array<std::pair<UChar32, char>, 25> kSmallCapitals = {
    {{0x1d00, 'a'}, {0x0299, 'b'}, {0x1d04, 'c'}, {0x1d05, 'd'}, {0x1d07, 'e'},
     {0xa730, 'f'}, {0x0262, 'g'}, {0x029c, 'h'}, {0x026a, 'i'}, {0x1d0a, 'j'},
     {0x1d0b, 'k'}, {0x029f, 'l'}, {0x1d0d, 'm'}, {0x0274, 'n'}, {0x1d0f, 'o'},
     {0x1d18, 'p'}, {0xa7af, 'q'}, {0x0280, 'r'}, {0xa731, 's'}, {0x1d1b, 't'},
     {0x1d1c, 'u'}, {0x1d20, 'v'}, {0x1d21, 'w'}, {0x028f, 'y'}, {0x1d22, 'z'}}};

/// Calls `each` with the characters of well-formed UTF-8 and the bytes of each.
void for_each_character(std::string_view text,
                        const std::function<void(UChar32, std::string_view)>& each) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  const auto size = static_cast<std::int32_t>(text.size());
  for (std::int32_t at = 0; at < size;) {
    const std::int32_t first = at;
    UChar32 character = 0;
    U8_NEXT(bytes, at, size, character);
    RUNSTONE_ASSERT(character >= 0);
    each(character,
         text.substr(static_cast<std::size_t>(first), static_cast<std::size_t>(at - first)));
  }
}

std::string without_small_capitals(std::string_view text) {
  std::string out;
  for_each_character(text, [&](UChar32 character, std::string_view bytes) {
    for (const auto& [small_capital, letter] : kSmallCapitals) {
      if (character != small_capital) continue;
      out += letter;
      return;
    }
    out += bytes;
  });
  return out;
}

std::string letters_and_digits(std::string_view text) {
  std::string out;
  for_each_character(text, [&](UChar32 character, std::string_view bytes) {
    if (u_isalnum(character) != 0) out += bytes;
  });
  return out;
}

/// Returns what uspoof_getSkeletonUTF8() makes of a text.
std::string confusable_skeleton(const std::string& text) {
  UErrorCode error = U_ZERO_ERROR;
  // Threads may share a checker that nobody changes.
  static const USpoofChecker* const checker = uspoof_open(&error);
  RUNSTONE_ASSERT(checker != nullptr);
  error = U_ZERO_ERROR;
  std::string out(4 * text.size() + 16, '\0');
  const auto bytes_of = [](const std::string& bytes) {
    return static_cast<std::int32_t>(bytes.size());
  };
  std::int32_t size = uspoof_getSkeletonUTF8(checker, 0, text.data(), bytes_of(text), out.data(),
                                             bytes_of(out), &error);
  if (error == U_BUFFER_OVERFLOW_ERROR) {
    error = U_ZERO_ERROR;
    out.resize(static_cast<std::size_t>(size) + 1);
    size = uspoof_getSkeletonUTF8(checker, 0, text.data(), bytes_of(text), out.data(),
                                  bytes_of(out), &error);
  }
  RUNSTONE_ASSERT(U_SUCCESS(error));
  out.resize(static_cast<std::size_t>(size));
  return out;
}

/// Returns the skeleton of the letters and digits. A skeleton may have capital letters ("l" looks
/// like "I" and "0" like "O"), so it is folded and made once more.
std::string skeleton_of(std::string_view text) {
  const std::string first = letters_and_digits(confusable_skeleton(without_small_capitals(text)));
  return letters_and_digits(confusable_skeleton(folded_name(first)));
}

std::string upper_case(std::string_view text) {
  UErrorCode error = U_ZERO_ERROR;
  std::array<UChar, 512> wide{};
  std::array<UChar, 1024> upper{};
  std::array<char, 4096> bytes{};
  const auto room = [](const auto& buffer) { return static_cast<std::int32_t>(buffer.size()); };
  std::int32_t size = 0;
  u_strFromUTF8(wide.data(), room(wide), &size, text.data(), room(text), &error);
  size = u_strToUpper(upper.data(), room(upper), wide.data(), size, "", &error);
  u_strToUTF8(bytes.data(), room(bytes), &size, upper.data(), size, &error);
  // A text that is too long for this is no name of a player.
  return U_SUCCESS(error) ? std::string(bytes.data(), static_cast<std::size_t>(size))
                          : std::string(text);
}

}  // namespace

Skeletons skeletons_of(std::string_view text) {
  return {skeleton_of(text), skeleton_of(folded_name(text))};
}

std::set<std::string> protected_skeletons_of(std::string_view name) {
  const Skeletons both = skeletons_of(name);
  std::set<std::string> out{both.written, both.folded, skeleton_of(upper_case(name))};
  out.erase(std::string());
  return out;
}

std::vector<std::string> name_words(std::string_view text) {
  std::vector<std::string> words(1);
  for_each_character(text, [&](UChar32 character, std::string_view bytes) {
    const auto kind = u_charType(character);
    const bool parts_nothing = kind == U_NON_SPACING_MARK || kind == U_ENCLOSING_MARK ||
                               kind == U_COMBINING_SPACING_MARK || kind == U_FORMAT_CHAR;
    if (u_isalnum(character) != 0 || parts_nothing) {
      words.back() += bytes;
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  });
  if (words.back().empty()) words.pop_back();
  return words;
}

}  // namespace runstone
