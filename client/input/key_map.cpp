#include "client/input/key_map.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

std::size_t index_of(Action action) { return static_cast<std::size_t>(action); }

bool matches(const KeyChord& chord, const KeyEvent& event, bool with_shift) {
  return chord.key == event.key && chord.control == event.control && chord.alt == event.alt &&
         chord.shift == with_shift && (!with_shift || event.shift);
}

}  // namespace

KeyMap::KeyMap() {
  for (const ActionInfo& row : action_table()) {
    auto chords = parse_key_chords(row.default_keys);
    RUNSTONE_ASSERT(chords.has_value());
    chords_[index_of(row.action)] = *std::move(chords);
  }
}

void KeyMap::bind(Action action, std::vector<KeyChord> chords) {
  // A held key acts with shift as well, because shift is the key of another held action.
  const bool is_held = info_of(action).is_held;
  for (auto& others : chords_) {
    std::erase_if(others, [&](const KeyChord& chord) {
      const KeyChord plain{chord.key, chord.control, false, chord.alt};
      return std::any_of(chords.begin(), chords.end(), [&](const KeyChord& bound) {
        return bound == chord || (is_held && bound == plain);
      });
    });
  }
  chords_[index_of(action)] = std::move(chords);
}

const std::vector<KeyChord>& KeyMap::keys_of(Action action) const {
  return chords_[index_of(action)];
}

std::string KeyMap::keys_text(Action action) const {
  std::string text;
  for (const KeyChord& chord : keys_of(action)) text += (text.empty() ? "" : ", ") + text_of(chord);
  return text;
}

std::optional<Action> KeyMap::pressed(const KeyEvent& event) const {
  // A chord with shift comes before the same chord without it.
  for (const bool with_shift : {true, false}) {
    for (const ActionInfo& row : action_table()) {
      if (row.is_held) continue;
      for (const KeyChord& chord : keys_of(row.action)) {
        if (matches(chord, event, with_shift)) return row.action;
      }
    }
  }
  return std::nullopt;
}

std::optional<Action> KeyMap::held(Key place) const {
  for (const ActionInfo& row : action_table()) {
    if (!row.is_held) continue;
    for (const KeyChord& chord : keys_of(row.action)) {
      if (chord.key == place) return row.action;
    }
  }
  return std::nullopt;
}

std::optional<std::vector<KeyChord>> parse_key_chords(std::string_view text) {
  std::vector<KeyChord> chords;
  while (!text.empty()) {
    const std::size_t length = std::min(text.find(' '), text.size());
    if (length != 0) {
      const auto chord = parse_key_chord(text.substr(0, length));
      if (!chord) return std::nullopt;
      chords.push_back(*chord);
    }
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return chords;
}

}  // namespace runstone
