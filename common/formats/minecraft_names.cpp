// The names of the materials that Minecraft's blocks become, and back.
#include <algorithm>

#include "common/core/hash.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/minecraft_states.hpp"

namespace runstone {
namespace {

constexpr std::string_view kNamespace = "minecraft:";
constexpr std::string_view kDigits = "0123456789abcdefghijklmnopqrstuvwxyz";

/// Returns true for "namespace:path" of the characters that the game allows.
bool is_block_name(std::string_view name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string_view::npos || colon == 0 || colon + 1 == name.size()) return false;
  return std::all_of(name.begin(), name.end(), [&](const char& c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.' ||
           (c == '/' && &c > name.data() + colon) || &c == name.data() + colon;
  });
}

std::string_view path_of(std::string_view name) { return name.substr(name.find(':') + 1); }

/// Returns the form with a hash.
std::string hashed_name(const ForeignBlock& block) {
  std::string out = block.name.substr(0, kMaterialNameBytesMax - 17);
  for (char& c : out) {
    if (c <= 0x20 || c >= 0x7f) c = '?';
  }
  out += '#';
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
  const auto add = [&](std::string_view text) {
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  };
  add(block.name);
  add("[");
  add(block.states);
  hash = mix64(hash);
  for (int shift = 60; shift >= 0; shift -= 4) out += kDigits[hash >> shift & 15];
  return out;
}

/// Returns the states with each property that they lack at its default.
StateList completed(const StateList& states, const std::vector<MinecraftProperty>& properties) {
  StateList out = states;
  for (const MinecraftProperty property : properties) {
    const auto key = key_of(property);
    if (std::none_of(states.begin(), states.end(),
                     [&](const auto& state) { return state.first == key; }))
      out.emplace_back(key, value_of(property, 0));
  }
  std::sort(out.begin(), out.end());
  return out;
}

bool has_keys(const StateList& states, const std::vector<MinecraftProperty>& properties) {
  return std::equal(states.begin(), states.end(), properties.begin(), properties.end(),
                    [](const auto& state, MinecraftProperty property) {
                      return state.first == key_of(property);
                    });
}

/// Returns the states that are not the default of a property.
StateList without_defaults(const StateList& states,
                           const std::vector<MinecraftProperty>& properties) {
  StateList out;
  for (const auto& state : states) {
    if (std::none_of(properties.begin(), properties.end(), [&](MinecraftProperty property) {
          return key_of(property) == state.first && value_of(property, 0) == state.second;
        }))
      out.push_back(state);
  }
  return out;
}

/// Returns one digit for each property, or nullopt if the states have another key or value.
std::optional<std::string> digits_of(const StateList& states,
                                     const std::vector<MinecraftProperty>& properties) {
  if (!has_keys(states, properties)) return std::nullopt;
  std::string out;
  for (std::size_t i = 0; i < properties.size(); ++i) {
    const auto index = index_of_value(properties[i], states[i].second);
    if (!index || *index >= kDigits.size()) return std::nullopt;
    out += kDigits[*index];
  }
  return out;
}

}  // namespace

ForeignBlock with_default_states(const ForeignBlock& block) {
  ForeignBlock out = block;
  if (out.name.find(':') == std::string::npos) out.name.insert(0, kNamespace);
  if (!out.name.starts_with(kNamespace)) return out;
  const auto states = split_states(block.states);
  if (states) out.states = join_states(completed(*states, minecraft_properties(path_of(out.name))));
  return out;
}

std::string minecraft_material_name(const ForeignBlock& block) {
  std::string name = block.name;
  if (name.find(':') == std::string::npos) name.insert(0, kNamespace);
  const bool is_of_game = name.starts_with(kNamespace);
  if (name == "minecraft:air" || name == "minecraft:cave_air" || name == "minecraft:void_air")
    return "air";
  const auto given = split_states(block.states);
  if (!given || !is_block_name(name)) return hashed_name(block);
  const auto properties = minecraft_properties(path_of(name));
  const StateList states = is_of_game ? completed(*given, properties) : *given;
  const auto extended = [&](char open, const StateList& list, char close) {
    return list.empty() && open == '[' ? name : name + open + join_states(list) + close;
  };
  // A block of another namespace may have states that only look like those of the game.
  const std::string text = is_of_game || properties.empty() || has_keys(states, properties)
                               ? extended('[', without_defaults(states, properties), ']')
                               : extended('{', states, '}');
  if (text.size() <= kMaterialNameBytesMax) return text;
  const auto digits = digits_of(states, properties);
  if (digits && name.size() + 1 + digits->size() <= kMaterialNameBytesMax)
    return name + '~' + *digits;
  return hashed_name({name, join_states(states)});
}

std::optional<ForeignBlock> block_of_minecraft_material(std::string_view name) {
  if (name == "air") return ForeignBlock{"minecraft:air", ""};
  const std::size_t mark = std::min(name.find_first_of("[{~#"), name.size());
  const std::string_view block = name.substr(0, mark), rest = name.substr(mark);
  if (!is_block_name(block)) return std::nullopt;
  const auto properties = minecraft_properties(path_of(block));
  ForeignBlock out{std::string(block), ""};
  if (rest.starts_with('~')) {
    if (rest.size() != properties.size() + 1) return std::nullopt;
    StateList states;
    for (std::size_t i = 0; i < properties.size(); ++i) {
      const std::size_t index = kDigits.find(rest[i + 1]);
      if (index >= value_count(properties[i])) return std::nullopt;
      states.emplace_back(key_of(properties[i]), value_of(properties[i], index));
    }
    out.states = join_states(states);
  } else if (!rest.empty()) {
    const bool is_exact = rest.front() == '{';
    if (rest.front() == '#' || rest.size() < 2 || rest.back() != (is_exact ? '}' : ']'))
      return std::nullopt;
    const auto states = split_states(rest.substr(1, rest.size() - 2));
    if (!states) return std::nullopt;
    out.states = join_states(is_exact ? *states : completed(*states, properties));
  } else {
    out.states = join_states(completed({}, properties));
  }
  // Only names that minecraft_material_name() gives are accepted.
  if (minecraft_material_name(out) != name) return std::nullopt;
  return out;
}

}  // namespace runstone
