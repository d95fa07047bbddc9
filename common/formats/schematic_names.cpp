#include "common/formats/schematic_names.hpp"

#include <algorithm>
#include <optional>

#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/shape_names.hpp"

namespace runstone {
namespace {

constexpr std::string_view kGameNamespace = "minecraft:";
constexpr std::string_view kRunstoneNamespace = "runstone:";
constexpr std::string_view kRunstoneState = "runstone=";

bool is_lower_or_digit(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); }
bool is_word_char(char c) { return is_lower_or_digit(c) || c == '_'; }
bool is_namespace_char(char c) { return is_word_char(c) || c == '.' || c == '-'; }
bool is_path_char(char c) { return is_namespace_char(c) || c == '/'; }

bool is_identifier(std::string_view name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string_view::npos || colon == 0 || colon + 1 == name.size()) return false;
  const std::string_view space = name.substr(0, colon), path = name.substr(colon + 1);
  return std::all_of(space.begin(), space.end(), is_namespace_char) &&
         std::all_of(path.begin(), path.end(), is_path_char);
}

/// Returns true if a file can hold the name without the rule for other names.
bool is_plain_block_name(std::string_view name) {
  return is_identifier(name) && !name.starts_with(kRunstoneNamespace) && name != kUntouchedBlock;
}

bool is_word(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_word_char);
}

bool are_plain_states(std::string_view states) {
  if (states.empty() || states.back() == ',') return states.empty();
  std::string_view before;
  while (!states.empty()) {
    const std::size_t comma = states.find(',');
    const std::string_view state = states.substr(0, comma);
    const std::size_t equals = state.find('=');
    if (equals == std::string_view::npos) return false;
    const std::string_view key = state.substr(0, equals);
    if (!is_word(key) || !is_word(state.substr(equals + 1)) || key <= before) return false;
    if (key == kRunstoneState.substr(0, kRunstoneState.size() - 1)) return false;
    before = key;
    states = comma == std::string_view::npos ? std::string_view() : states.substr(comma + 1);
  }
  return true;
}

/// An escape sign, and the bytes that stay as they are. A blank becomes `blank`, if that is not 0.
struct EscapeRule {
  char sign;
  char blank;
  bool (*is_kept)(char);
};
constexpr EscapeRule kNameRule = {
    '.', '_', [](char c) { return is_lower_or_digit(c) || c == '-' || c == '/'; }};
constexpr EscapeRule kStatesRule = {'_', 0, is_lower_or_digit};

std::string escaped(std::string_view text, const EscapeRule& rule) {
  constexpr std::string_view kHexDigits = "0123456789abcdef";
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (rule.is_kept(c))
      out += c;
    else if (c == ' ' && rule.blank != 0)
      out += rule.blank;
    else
      (out += rule.sign) += {kHexDigits[byte >> 4], kHexDigits[byte & 15u]};
  }
  return out;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/// Returns the text of which escaped() makes `text`, or nullopt if there is none.
std::optional<std::string> unescaped(std::string_view text, const EscapeRule& rule) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == rule.sign && text.size() - i > 2) {
      const int high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
      if (high < 0 || low < 0) return std::nullopt;
      out += static_cast<char>(high << 4 | low);
      i += 2;
    } else {
      out += text[i] == rule.blank && rule.blank != 0 ? ' ' : text[i];
    }
  }
  if (escaped(out, rule) != text) return std::nullopt;
  return out;
}

}  // namespace

bool is_untouched_in_schematic(std::string_view text) {
  const std::string_view name = text.substr(0, text.find('['));
  return name == kUntouchedBlock || name == kUntouchedBlock.substr(kUntouchedBlock.find(':') + 1);
}

ForeignBlock block_of_schematic(std::string_view name, std::vector<BlockProperty> properties) {
  ForeignBlock block;
  if (name.find(':') == std::string_view::npos) block.name = kGameNamespace;
  block.name += name;
  std::sort(properties.begin(), properties.end());
  for (const auto& [key, value] : properties) {
    if (!block.states.empty()) block.states += ',';
    block.states += key;
    if (!value.empty()) (block.states += '=') += value;
  }
  if (std::string_view(block.states).starts_with(kRunstoneState)) {
    auto plain =
        unescaped(std::string_view(block.states).substr(kRunstoneState.size()), kStatesRule);
    if (plain && !plain->empty() && !are_plain_states(*plain)) block.states = *std::move(plain);
  }
  return block;
}

ForeignBlock block_of_schematic_text(std::string_view text) {
  const std::size_t open = text.find('[');
  if (open == std::string_view::npos) return block_of_schematic(text, {});
  std::string_view states = text.substr(open + 1);
  if (states.ends_with(']')) states.remove_suffix(1);
  return block_of_schematic(text.substr(0, open), properties_of(states));
}

std::vector<BlockProperty> properties_of(std::string_view states) {
  std::vector<BlockProperty> out;
  while (!states.empty()) {
    const std::size_t comma = states.find(',');
    const std::string_view state = states.substr(0, comma);
    const std::size_t equals = std::min(state.find('='), state.size());
    out.emplace_back(state.substr(0, equals), state.substr(std::min(equals + 1, state.size())));
    states = comma == std::string_view::npos ? std::string_view() : states.substr(comma + 1);
  }
  return out;
}

MaterialInfo material_of_schematic_block(const ForeignBlock& block, bool keep_all) {
  if (!block.name.starts_with(kRunstoneNamespace))
    return material_of_minecraft_block(block, keep_all);
  MaterialInfo info = material_of_minecraft_block(block, true);
  const auto name =
      unescaped(std::string_view(block.name).substr(kRunstoneNamespace.size()), kNameRule);
  if (name && *name != "air" &&
      validate_material(*name, info.colour, info.visibility, info.body, info.look)) {
    info.name = *name;
    info.shape = shape_of_material_name(*name).value_or(Shape{});
    if (info.visibility == Visibility::empty) info.shape = {};
  }
  return info;
}

ForeignBlock schematic_block_of(const BuildMaterial& material) {
  const std::string& name = material.row.name;
  const bool is_plain = is_plain_block_name(name);
  ForeignBlock block{name, material.states};
  bool is_block = is_plain;
  if (!is_plain || (material.states.empty() && name.starts_with(kGameNamespace))) {
    const auto known = block_of_minecraft_material(name);
    if (known && is_plain_block_name(known->name)) {
      is_block = true;
      block.name = known->name;
      if (material.states.empty()) block.states = known->states;
    }
  }
  const bool is_same = is_block && (block.name.starts_with(kGameNamespace) ||
                                    minecraft_material_name(block) == name);
  if (!is_same)
    block = {std::string(kRunstoneNamespace) + escaped(name, kNameRule), material.states};
  if (!are_plain_states(block.states))
    block.states = std::string(kRunstoneState) + escaped(block.states, kStatesRule);
  return block;
}

std::string schematic_text_of(const ForeignBlock& block) {
  return block.states.empty() ? block.name : block.name + '[' + block.states + ']';
}

}  // namespace runstone
