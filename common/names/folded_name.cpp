#include "common/names/folded_name.hpp"

#include <utf8proc.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"

namespace runstone {
namespace {

using CodePoint = utf8proc_int32_t;

struct ScriptRange {
  CodePoint first, last;
  unsigned script;
};
constexpr std::array<const char*, 3> kScripts = {"Latin", "Greek", "Cyrillic"};
/// The blocks of letters of kScripts (Unicode 15, Scripts.txt), as far as folded text has them.
constexpr std::array<ScriptRange, 15> kScriptRanges = {{{0x0061, 0x007a, 0},
                                                        {0x00df, 0x00f6, 0},
                                                        {0x00f8, 0x02af, 0},
                                                        {0x0370, 0x03ff, 1},
                                                        {0x0400, 0x052f, 2},
                                                        {0x1c80, 0x1c8f, 2},
                                                        {0x1d00, 0x1d25, 0},
                                                        {0x1d26, 0x1d2a, 1},
                                                        {0x1e00, 0x1eff, 0},
                                                        {0x1f00, 0x1fff, 1},
                                                        {0x2c60, 0x2c7f, 0},
                                                        {0x2de0, 0x2dff, 2},
                                                        {0xa640, 0xa69f, 2},
                                                        {0xa722, 0xa7ff, 0},
                                                        {0xab30, 0xab64, 0}}};

/// Returns the characters of well-formed UTF-8.
std::vector<CodePoint> characters_of(std::string_view text) {
  std::vector<CodePoint> characters;
  const auto* bytes = reinterpret_cast<const utf8proc_uint8_t*>(text.data());
  for (std::size_t at = 0; at < text.size();) {
    CodePoint character = 0;
    const utf8proc_ssize_t read =
        utf8proc_iterate(bytes + at, static_cast<utf8proc_ssize_t>(text.size() - at), &character);
    RUNSTONE_ASSERT(read > 0);
    characters.push_back(character);
    at += static_cast<std::size_t>(read);
  }
  return characters;
}

std::string mapped_by(int options, std::string_view text) {
  utf8proc_uint8_t* mapped = nullptr;
  const utf8proc_ssize_t size = utf8proc_map(reinterpret_cast<const utf8proc_uint8_t*>(text.data()),
                                             static_cast<utf8proc_ssize_t>(text.size()), &mapped,
                                             static_cast<utf8proc_option_t>(options));
  RUNSTONE_ASSERT(size >= 0);
  std::string out(reinterpret_cast<const char*>(mapped), static_cast<std::size_t>(size));
  std::free(mapped);
  return out;
}

/// Returns NFKC_Casefold of the text's NFD (Unicode 15, definition D147). Without NFD first, the
/// letter that U+0345 folds to would stand where the mark stood, and marks have many orders.
std::string casefolded(std::string_view text) {
  return mapped_by(
      UTF8PROC_STABLE | UTF8PROC_COMPOSE | UTF8PROC_COMPAT | UTF8PROC_CASEFOLD | UTF8PROC_IGNORE,
      mapped_by(UTF8PROC_STABLE | UTF8PROC_DECOMPOSE, text));
}

std::string with_single_blanks(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c != ' ' || (!out.empty() && out.back() != ' ')) out += c;
  }
  if (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

/// Returns a text such as "it mixes Latin and Greek letters", or nullopt.
std::optional<std::string> mixed_scripts(std::string_view folded) {
  std::optional<unsigned> first;
  for (const CodePoint character : characters_of(folded)) {
    const auto range = std::find_if(
        kScriptRanges.begin(), kScriptRanges.end(),
        [&](const ScriptRange& r) { return character >= r.first && character <= r.last; });
    if (range == kScriptRanges.end()) continue;
    if (!first) first = range->script;
    if (*first == range->script) continue;
    const auto [a, b] = std::minmax(*first, range->script);
    return std::string("it mixes ") + kScripts[a] + " and " + kScripts[b] +
           " letters, many of which look the same";
  }
  return std::nullopt;
}

}  // namespace

std::string folded_name(std::string_view name) {
  // One pass is not always enough: a character may fold to one that composes with its neighbour.
  // Every pass but the first changes few texts, and none was seen to need a fourth.
  std::string folded(name);
  for (int pass = 0; pass < 8; ++pass) {
    std::string next = with_single_blanks(casefolded(folded));
    if (next == folded) break;
    folded = std::move(next);
  }
  return folded;
}

std::optional<std::string> name_fault(std::string_view name) {
  if (!is_plain_name(name))
    return "it is empty, has blanks at its ends, quotes, backslashes or invisible characters";
  const std::vector<CodePoint> characters = characters_of(name);
  for (const CodePoint character : characters) {
    const utf8proc_category_t category = utf8proc_category(character);
    if (category == UTF8PROC_CATEGORY_CN || category == UTF8PROC_CATEGORY_CO)
      return "it has a character that this server does not know";
  }
  const std::string folded = folded_name(name);
  const auto is_mark = [](CodePoint character) {
    const utf8proc_category_t category = utf8proc_category(character);
    return category == UTF8PROC_CATEGORY_MN || category == UTF8PROC_CATEGORY_MC ||
           category == UTF8PROC_CATEGORY_ME;
  };
  if (folded.empty() || is_mark(characters.front()) || is_mark(characters_of(folded).front()))
    return "it begins with a combining mark";
  return mixed_scripts(folded);
}

}  // namespace runstone
