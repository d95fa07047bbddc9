// KeyMap: which keys do what. It begins with the default keys of the action table.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/input/action.hpp"
#include "client/input/input_event.hpp"
#include "client/input/key.hpp"

namespace runstone {

class KeyMap {
 public:
  KeyMap();

  /// Replaces the keys of an action. An empty list leaves it without a key. The keys are taken from
  /// actions that had them. A held action takes its keys with shift as well.
  void bind(Action action, std::vector<KeyChord> chords);
  const std::vector<KeyChord>& keys_of(Action action) const;
  /// Returns the keys for people, such as "T, enter".
  std::string keys_text(Action action) const;
  /// Returns the action that this press triggers, which is not held, or nullopt. Chords without
  /// control and alt match only without them; shift is ignored unless a chord has it.
  std::optional<Action> pressed(const KeyEvent& event) const;
  /// Returns the held action of the key at this place, with any modifiers, or nullopt.
  std::optional<Action> held(Key place) const;

 private:
  std::array<std::vector<KeyChord>, kActionCount> chords_;
};

/// Reads chords with blanks between them. Returns nullopt if one is wrong.
std::optional<std::vector<KeyChord>> parse_key_chords(std::string_view text);

}  // namespace runstone
