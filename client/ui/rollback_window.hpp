// RollbackWindow: the user chooses here the edits that a rollback takes back, and sees what it
// would change before it is applied. One thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone {

enum class RollbackArea : std::uint8_t { everywhere, around_me, selection };

/// Which edits a rollback takes back.
struct RollbackChoice {
  std::optional<AuthorId> author;  // nullopt: of everybody
  int minutes = 60;                // no older than this; 1 .. kRollbackMinutesMax
  RollbackArea area = RollbackArea::everywhere;
  int radius = 32;  // of around_me, in voxels; 1 .. kRollbackRadiusMax
  friend bool operator==(const RollbackChoice&, const RollbackChoice&) = default;
};
inline constexpr int kRollbackMinutesMax = 60 * 24 * 30;
inline constexpr int kRollbackRadiusMax = 512;

enum class RollbackPhase : std::uint8_t {
  idle,        // nothing was chosen yet, or it was forgotten
  previewing,  // the server computes
  previewed,   // the ghosts show what would change
  applying,
  applied,
  undoing,
};

/// The content of the window.
struct RollbackState {
  bool is_allowed = false;                                // the player's role has the right
  std::vector<std::pair<AuthorId, std::string>> authors;  // to choose from
  bool has_selection = false;
  RollbackPhase phase = RollbackPhase::idle;
  std::vector<std::string> answer;        // lines of the server
  std::uint64_t voxels = 0, chunks = 0;   // that would change
  std::uint64_t placed = 0, removed = 0;  // voxels of the ghosts
  bool is_cut = false;                    // there are more changes than ghosts
};

/// An order of the user.
struct PreviewRollback {
  RollbackChoice choice;
};
struct ApplyRollback {};
struct UndoRollback {};
struct ForgetRollback {};
using RollbackOrder = std::variant<PreviewRollback, ApplyRollback, UndoRollback, ForgetRollback>;

class RollbackWindow {
 public:
  void toggle() { is_open_ = !is_open_; }
  bool close() { return std::exchange(is_open_, false); }
  bool is_open() const { return is_open_; }
  /// Makes the window with ImGui. Returns what the user ordered.
  std::optional<RollbackOrder> build(const RollbackState& state, double scale);

 private:
  void build_choice(const RollbackState& state);
  std::optional<RollbackOrder> build_buttons(const RollbackState& state);

  bool is_open_ = false;
  RollbackChoice choice_;
};

}  // namespace runstone
