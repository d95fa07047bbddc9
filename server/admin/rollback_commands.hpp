// The commands that search the log and take the edits of others back: log and rollback.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "common/materials/material_table.hpp"
#include "server/admin/command_row.hpp"

namespace runstone {

/// Selects edits by author, time, place and cause. A field that is not set selects all edits.
struct CommandFilter {
  /// A player, by author number ("#3"), by a word of KnownPlayers::find(), or by a pattern of names
  /// (is_name_pattern).
  struct Author {
    std::string name;  // empty: by number
    std::optional<AuthorId> number;
    friend bool operator==(const Author&, const Author&) = default;
  };
  std::vector<Author> authors;              // edits of any of them; empty: of everybody
  std::vector<std::string> address_of;      // also those who share an address with one of these
  std::vector<Author> not_authors;          // edits of none of them
  std::optional<TimeUs> joined_after_us;    // UTC; edits of players who joined later
  std::optional<TimeUs> from_us, until_us;  // UTC, both included
  std::optional<VoxelBox> box;
  std::string in;  // the name of a protected box, in place of `box`; empty: none
  std::optional<Cause> cause;
  /// Returns true if players must be looked up.
  bool is_about_players() const {
    return !authors.empty() || !address_of.empty() || !not_authors.empty() || joined_after_us;
  }
  friend bool operator==(const CommandFilter&, const CommandFilter&) = default;
};

/// Patterns of names in one line at most. Each is compared with all names of the world.
inline constexpr std::size_t kPatternsMax = 8;

inline constexpr std::uint64_t kLogLinesMax = 1000;
struct LogCommand {
  CommandFilter filter;
  std::uint64_t limit = 20;  // newest edits, 1 .. kLogLinesMax
  friend bool operator==(const LogCommand&, const LogCommand&) = default;
};
struct RollbackPreviewCommand {
  CommandFilter filter;
  bool picture = false;  // draw the area before and after the rollback
  friend bool operator==(const RollbackPreviewCommand&, const RollbackPreviewCommand&) = default;
};

std::span<const CommandRow> rollback_commands();

/// Returns the name that filters and answers use: "player", "rollback", ...
std::string_view name_of(Cause cause);

/// Returns a line such as
///   "9120 2026-11-21T23:57:42Z ana #3 9M1Q-Z7CR-04KD player box 1 2 3 to 4 5 6 := stone"
/// where both corners are inside. `author` is a text of KnownPlayers. For an undo, redo or rollback
/// the line names the edit that it refers to instead of a kind: "undo of 9100 restored 1 2 3". An
/// edit that belongs to an action of several names the first one: "player with 9100 box ...". The
/// material is left out if the edit restores voxels or pastes a clipboard, and if the table does
/// not have it. The line of a change of rights ends with rights_change_text().
std::string log_line(const EditRecord& record, const std::string& author,
                     const MaterialTable& materials);

}  // namespace runstone
