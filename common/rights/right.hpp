// Right: one thing that a role allows or does not allow.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string_view>

namespace runstone {

/// Values are frozen: they are stored. Further rights get further values, at most 31.
enum class Right : std::uint8_t {
  see = 0,              // join, and see the world as it is
  build = 1,            // change ground that no box protects
  build_protected = 2,  // change ground that boxes of others protect
  claim = 3,            // protect ground of one's own, within the quota of the role
  protect = 4,          // protect any ground, change and remove the boxes of others
  look_back = 5,        // see the world as it was
  undo = 6,             // take one's own edits back
  roll_back = 7,        // search the log, and take back the edits of others
  chat = 8,             // write to the other players
  moderate = 9,         // kick, mute, freeze and ban players
  grant = 10,           // give players roles
  administer = 11       // everything else: roles, names, materials, the stop of the server
};
inline constexpr std::size_t kRightCount = 12;

/// Returns the name of a right in commands and answers, such as "build_protected".
std::string_view name_of(Right right);
/// Returns the right of this name, or nullopt.
std::optional<Right> right_named(std::string_view name);

class RightSet {
 public:
  constexpr RightSet() = default;
  constexpr RightSet(std::initializer_list<Right> rights) {
    for (const Right right : rights) bits_ |= bit(right);
  }
  static constexpr RightSet all() { return of_bits((1U << kRightCount) - 1); }
  /// Bit n is the right with the value n.
  static constexpr RightSet of_bits(std::uint32_t bits) {
    RightSet out;
    out.bits_ = bits;
    return out;
  }
  constexpr std::uint32_t bits() const { return bits_; }

  constexpr bool has(Right right) const { return (bits_ & bit(right)) != 0; }
  constexpr void add(Right right) { bits_ |= bit(right); }
  constexpr void remove(Right right) { bits_ &= ~bit(right); }
  /// Returns the rights of this set that the other one has not.
  constexpr RightSet without(RightSet other) const { return of_bits(bits_ & ~other.bits_); }
  /// Returns the rights that both sets have.
  constexpr RightSet and_in(RightSet other) const { return of_bits(bits_ & other.bits_); }
  /// Returns true if every right of the other set is in this one.
  constexpr bool includes(RightSet other) const { return (other.bits_ & ~bits_) == 0; }
  friend constexpr bool operator==(RightSet, RightSet) = default;

 private:
  static constexpr std::uint32_t bit(Right right) { return 1U << static_cast<unsigned>(right); }
  std::uint32_t bits_ = 0;
};

/// The rights with which a player acts on other players and on their ground.
inline constexpr RightSet kRightsOverOthers = {Right::build_protected, Right::protect,
                                               Right::roll_back,       Right::moderate,
                                               Right::grant,           Right::administer};

}  // namespace runstone
