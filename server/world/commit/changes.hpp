// Changes: edits that the server makes itself: rollback, undo, redo, changes of rights, new
// materials, their shapes and textures, and changes of the library of builds. All are records of
// the log.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/world/commit/added_at.hpp"
#include "server/world/commit/commits.hpp"
#include "server/world/rights/quotas.hpp"

namespace runstone {

struct ServerEditsResult {
  enum class State {
    ordered,  // all offers
    busy,     // the first `count` offers; a limit rejects the next one for now: try again
    closed,   // none: accepts_edits() returns false
    taken,    // none: a client of the author has used these client sequences
  };
  State state = State::ordered;
  std::size_t count = 0;    // ordered offers, from the first on
  const char* reason = "";  // names the limit if busy
};

class Changes {
 public:
  /// The arguments must outlive the object.
  Changes(const WorldConfig& config, Sessions& sessions, Order& order, const Rights& rights,
          Quotas& quotas, Commits& commits)
      : config_(config),
        sessions_(sessions),
        order_(order),
        rights_(rights),
        quotas_(quotas),
        commits_(commits) {}

  /// Orders the offers at once and in order, as far as the log has room: behind all queued edits
  /// except large ones that wait for room (LargeEditPace) and the edits behind those. Requires that
  /// they pass check_server_edit(), that their client sequences ascend, that they have one author
  /// and instance, and that their cause is not player. The edits of a large action are the exception:
  /// they have the cause player, pass check_edit(), and large ones wait for room as those of
  /// clients. Each offer costs its edit_price(), paid by the key of the author `payer` and the
  /// address of the author's first session. An author without a session pays by the key alone.
  /// Nobody pays if `payer` is 0.
  ServerEditsResult order_edits(const std::vector<EditOffer>& offers, AuthorId payer,
                                const Clocks& now);
  /// Orders a change of rights as a record of the log, made by the author (0: the console), who
  /// pays for it as for an edit. It is in force on return. Sessions that may not stay are closed. A
  /// full disk does not keep those from it who have power over others: a ban must not wait. Returns
  /// its sequence, or why it was refused, as a sentence.
  Result<Sequence, std::string> change_rights(const RightsChange& change, const RightsActor& actor,
                                              AuthorId author, const Clocks& now);
  /// Reads both clocks for the time of the log. Commits do that too, but the first commit may come
  /// later than the call that needs the time.
  void read_clocks(const Clocks& now) { order_.authority().log_clock().advance(now); }
  /// Returns the record that makes the log's time that of the wall clock. Returns nullopt if none is
  /// needed, because the time does not step back, and no restriction or invite in force has an end of
  /// the time before: then accept_wall_clock() makes it so.
  std::optional<CorrectTime> time_correction() const;
  /// Makes the log's time that of the wall clock. Requires that it is not ahead.
  void accept_wall_clock() { order_.authority().accept_wall_clock(); }
  /// Makes the log's time that of a wall clock that has kept a jump ahead (LogClock::is_step_due()), by
  /// a record if one is needed. `refusal` is why no CorrectTime may be ordered, if so: then, and if
  /// the log takes no record, a later call tries again. Returns a line for the operator, if there is
  /// news.
  std::optional<std::string> accept_kept_jump(const std::optional<std::string>& refusal,
                                              const Clocks& now);
  /// Orders the addition of materials by the console, as one record of the log, and as records that
  /// give them their shapes if they have some: all or none. Looks become those of
  /// with_look_on_shape(). Refuses bad rows
  /// (MaterialTable::check_rows()), none or more than kAddedMaterialsMax of them, and while the log
  /// takes no edits.
  Result<AddedAt, MaterialsRefusal> add_materials(const std::vector<MaterialRow>& rows,
                                                  const Clocks& now);
  /// Orders shapes for materials of the world by the console, as records of the log: all or none.
  /// Requires at least one row. Returns the last record, or why it was refused, as a sentence: bad
  /// rows (MaterialTable::check_given()), and while the log takes no edits or lacks room for all.
  Result<Sequence, std::string> give_shapes(std::vector<GivenShape> rows, const Clocks& now);

  /// Orders textures for materials of the world by the console, one record for each: all or none.
  /// Requires at least one, and pictures for which read_texture() succeeds. Returns the last record,
  /// or why it was refused, as a sentence: a material that is not there, a side that has a picture
  /// already, too many pictures (TextureTable::check()), and while the log takes no edits or lacks
  /// room for all. Cost: O(uses), and O(bytes) of the pictures without a hash.
  Result<Sequence, std::string> give_textures(std::span<const GivenTexturePtr> textures,
                                              const Clocks& now);

  /// Orders the addition of a build by an author (0: the console), whose file is in the store.
  /// Returns its number, which is the sequence of the record, or why it was refused, as a sentence.
  Result<Sequence, std::string> add_build(const AddBuild& build, AuthorId author,
                                          const Clocks& now);
  /// Returns a content number for the file of a build, which was never used in the world.
  std::uint64_t next_build_content() { return order_.library().next_content(order_.epoch()); }
  /// Orders the removal of a build by an author (0: the console). Returns the sequence of the record,
  /// or why it was refused, as a sentence.
  Result<Sequence, std::string> remove_build(Sequence number, AuthorId author, const Clocks& now);

  /// Orders a record that sets the clock of the world, by an author (0: the console). Returns its
  /// sequence, or why it was refused, as a sentence. Requires is_valid(time).
  Result<Sequence, std::string> set_clock(const WorldTime& time, AuthorId author,
                                          const Clocks& now);

 private:
  Result<Sequence, std::string> change_library(const LibraryChange& change, AuthorId author,
                                               const Clocks& now);
  /// Orders materials, shapes and textures of the console, but none of them if the log lacks room
  /// for all. Up to kCommitEditsMax of them are one commit, so a crash does not leave materials
  /// without their shapes either.
  ServerEditsResult order_all(const std::vector<EditOffer>& offers, const Clocks& now);
  /// Appends the offers that give shapes. Requires rows that ascend by material.
  void offer_shapes(std::span<const GivenShape> rows, const Clocks& now,
                    std::vector<EditOffer>& offers);
  enum class DiskNeed {
    space,  // nothing is ordered while the disk is full
    none,   // what is ordered while the disk is full waits in memory
  };
  /// Returns the limit that rejects so many records for now, or nullopt if none does.
  std::optional<const char*> why_full(DiskNeed need, std::size_t records) const;
  ServerEditsResult order(const std::vector<EditOffer>& offers, AuthorId payer, DiskNeed need,
                          const Clocks& now);
  std::optional<Payer> payer_of(AuthorId author) const;
  bool has_power(const RightsActor& actor) const;

  const WorldConfig& config_;
  Sessions& sessions_;
  Order& order_;
  const Rights& rights_;
  Quotas& quotas_;
  Commits& commits_;
  bool is_jump_refused_ = false;  // accept_kept_jump() has reported that it cannot
};

}  // namespace runstone
