#include "common/materials/readable_name.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace runstone {
namespace {

constexpr std::array<std::string_view, 17> kColours = {
    "white", "grey", "gray",   "black",  "red",     "orange", "yellow", "green", "cyan",
    "blue",  "lime", "violet", "purple", "magenta", "pink",   "brown",  "silver"};

bool is_colour(std::string_view word) {
  return std::find(kColours.begin(), kColours.end(), word) != kColours.end();
}

bool is_shade(std::string_view word) { return word == "dark" || word == "light"; }

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> out;
  while (!text.empty()) {
    const std::size_t length = std::min(text.find('_'), text.size());
    if (length != 0) out.push_back(text.substr(0, length));
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return out;
}

/// Returns the number of words at the end that are a colour with its shade, 0 to 2.
std::size_t colour_at_end(const std::vector<std::string_view>& words) {
  if (words.empty() || !is_colour(words.back())) return 0;
  return words.size() > 1 && is_shade(words[words.size() - 2]) ? 2 : 1;
}

}  // namespace

std::string readable_name(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  const bool has_colon = colon != std::string_view::npos;
  std::vector<std::string_view> words = words_of(has_colon ? name.substr(colon + 1) : name);
  if (words.empty()) return std::string(name);
  const std::size_t colour = colour_at_end(words);
  if (colour == words.size() && has_colon) {
    for (const std::string_view noun : words_of(name.substr(0, colon))) words.push_back(noun);
  } else {
    std::rotate(words.begin(), words.end() - static_cast<std::ptrdiff_t>(colour), words.end());
  }
  std::string out;
  for (const std::string_view word : words) out.append(out.empty() ? "" : " ").append(word);
  if (out[0] >= 'a' && out[0] <= 'z') out[0] = static_cast<char>(out[0] - 'a' + 'A');
  return out;
}

}  // namespace runstone
