#include "client/play/world_kit.hpp"

#include <charconv>
#include <limits>

namespace runstone {
namespace {

/// Takes the first word of words that single blanks separate.
std::string_view take_word(std::string_view& words) {
  const std::string_view word = words.substr(0, words.find(' '));
  words.remove_prefix(word.size() == words.size() ? word.size() : word.size() + 1);
  return word;
}

std::optional<std::size_t> number_of(std::string_view word, std::size_t most) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size() || number > most)
    return std::nullopt;
  return number;
}

}  // namespace

std::string to_text(const WorldKit& kit) {
  std::string out = kit.tool + " " + std::to_string(kit.slot);
  for (const Material material : kit.slots) out += " " + std::to_string(material);
  return out;
}

std::optional<WorldKit> parse_kit(std::string_view text) {
  if (text.size() > kKitBytesMax) return std::nullopt;
  WorldKit kit;
  kit.tool = take_word(text);
  const auto slot = number_of(take_word(text), kSlotCount - 1);
  if (kit.tool.empty() || !slot) return std::nullopt;
  kit.slot = *slot;
  for (Material& material : kit.slots) {
    const auto id = number_of(take_word(text), std::numeric_limits<Material>::max());
    if (!id) return std::nullopt;
    material = static_cast<Material>(*id);
  }
  if (!text.empty()) return std::nullopt;
  return kit;
}

}  // namespace runstone
