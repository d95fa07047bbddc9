// Undo and redo of one player in a chunk, against models without selections: a stack of whole
// states while the player is alone, and the last writer of each voxel when others build there too.
#include "server/rollback/player_actions.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <optional>
#include <vector>

#include "common/edits/restore/restore.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

constexpr AuthorId kMe = 1, kOther = 2;
constexpr VoxelPos kOrigin = {0, 0, 0};

struct Entry {
  AuthorId author = 0;
  Cause cause = Cause::player;
  Sequence subject = 0;
  std::vector<EditDescriptor> edits;  // a record has one edit; an undo has one for each voxel
};

/// A log of one chunk, with undo and redo as a server does them: from the log alone.
class ChunkLog {
 public:
  explicit ChunkLog(RunChunk start) : start_(std::move(start)), now_(DenseChunk::of(start_)) {}

  const DenseChunk& now() const { return now_; }
  const RunChunk& start() const { return start_; }

  /// Adds an edit to the action that begins with `first`; 0: an action by itself. Returns its
  /// sequence.
  Sequence act(AuthorId author, const EditDescriptor& edit, Sequence first = 0) {
    append({author, Cause::player, first, {edit}});
    return log_.size();
  }

  /// Returns the action, or nullopt if there is none left. `skipped` is the number of actions
  /// without effect before it.
  std::optional<Sequence> undo(int* skipped = nullptr) {
    const PlayerActions mine(player_records());
    for (const Sequence action : mine.undoable()) {
      if (restore(mine.to_undo(action), Cause::undo, action)) return action;
      if (skipped != nullptr) ++*skipped;
    }
    return std::nullopt;
  }
  std::optional<Sequence> redo() {
    const PlayerActions mine(player_records());
    for (const Sequence action : mine.redoable()) {
      if (restore(mine.to_redo(action), Cause::redo, action)) return action;
    }
    return std::nullopt;
  }

 private:
  void append(Entry entry) {
    oracle_apply(now_, kOrigin, entry.edits);
    log_.push_back(std::move(entry));
  }
  PlayerRanges player_records() const {
    PlayerRanges out;
    for (std::size_t i = 0; i < log_.size(); ++i) {
      if (log_[i].author != kMe) continue;
      const bool continues = !out.empty() && log_[i].subject != 0 &&
                             out.back().cause == log_[i].cause &&
                             out.back().subject == log_[i].subject;
      if (continues) {
        out.back().last = i + 1;
      } else {
        out.push_back({i + 1, i + 1, log_[i].cause, log_[i].subject});
      }
    }
    return out;
  }
  bool restore(const PlayerRanges& selected, Cause cause, Sequence subject) {
    ApplyScratch scratch;
    ChunkRestore chunk(start_, kOrigin);
    for (std::size_t i = 0; i < log_.size(); ++i) {
      const bool is_selected =
          log_[i].author == kMe &&
          std::any_of(selected.begin(), selected.end(), [i](const PlayerRange& range) {
            return range.first <= i + 1 && i + 1 <= range.last;
          });
      for (const EditDescriptor& edit : log_[i].edits) chunk.add(edit, is_selected, scratch);
    }
    chunk.flush(scratch);
    std::vector<Difference> differences;
    append_differences(chunk.now(), chunk.restored(), differences);
    if (differences.empty()) return false;
    Entry entry{kMe, cause, subject, {}};
    for (const Difference& d : differences) {
      for (VoxelIndex i = d.first; i < d.last; ++i) {
        const VoxelPos at = dense_pos(start_.extent, start_.order, i);
        entry.edits.push_back({SetVoxel{at}, {}, d.restored});
      }
    }
    append(std::move(entry));
    return true;
  }

  RunChunk start_;
  DenseChunk now_;
  std::vector<Entry> log_;
};

RunChunk small_chunk(SplitMix64& rng) {
  return random_chunk(rng, Extent::cube(8), random_order(rng), 4);
}

/// Calls f(x, y, z) for each voxel.
template <class F>
void for_each_voxel(const DenseChunk& chunk, F&& f) {
  for (int z = 0; z < chunk.side_z(); ++z) {
    for (int y = 0; y < chunk.side_y(); ++y) {
      for (int x = 0; x < chunk.side_x(); ++x) f(x, y, z);
    }
  }
}

/// Marks the voxels that differ.
void mark_changes(DenseChunk& marks, const DenseChunk& before, const DenseChunk& after,
                  Material mark) {
  for_each_voxel(marks, [&](int x, int y, int z) {
    if (before.at(x, y, z) != after.at(x, y, z)) marks.set(x, y, z, mark);
  });
}

}  // namespace

TEST_CASE("undo and redo of a player alone step through a stack of states",
          "[rollback][property]") {
  SplitMix64 rng{71 + Catch::rngSeed()};
  int undone = 0, redone = 0, refused = 0;
  for (int round = 0; round < 60; ++round) {
    ChunkLog log(small_chunk(rng));
    std::vector<DenseChunk> states = {log.now()};  // states[at] is the current state
    std::size_t at = 0;
    for (int step = 0; step < 40; ++step) {
      CAPTURE(Catch::rngSeed(), round, step);
      const auto dice = rng.below(10);
      if (dice < 4) {
        const Sequence first = log.act(kMe, random_edit_near(rng, kOrigin, Extent::cube(8)));
        for (auto more = rng.below(3); more > 0; --more)
          log.act(kMe, random_edit_near(rng, kOrigin, Extent::cube(8)), first);
        states.erase(states.begin() + static_cast<std::ptrdiff_t>(at + 1),
                     states.end());  // after a new action there is nothing to redo
        if (!(log.now() == states[at])) {
          states.push_back(log.now());
          ++at;
        }
      } else if (dice < 7) {
        const auto action = log.undo();
        REQUIRE(action.has_value() == (at > 0));
        at -= action ? 1 : 0;
        undone += action ? 1 : 0;
        refused += action ? 0 : 1;
      } else {
        const auto action = log.redo();
        REQUIRE(action.has_value() == (at + 1 < states.size()));
        at += action ? 1 : 0;
        redone += action ? 1 : 0;
      }
      REQUIRE(log.now() == states[at]);
    }
  }
  CHECK(undone > 300);
  CHECK(redone > 150);
  CHECK(refused > 20);
}

TEST_CASE("undo and redo leave alone what others wrote last", "[rollback][property]") {
  SplitMix64 rng{72 + Catch::rngSeed()};
  int undone = 0, over_others = 0, came_back = 0;
  for (int round = 0; round < 60; ++round) {
    ChunkLog log(small_chunk(rng));
    DenseChunk last_writer(Extent::cube(8));  // 0 if no edit changed the voxel, else the author
    for (int step = 0; step < 40; ++step) {
      CAPTURE(Catch::rngSeed(), round, step);
      const DenseChunk before = log.now();
      const auto dice = rng.below(10);
      if (dice < 6) {
        const AuthorId author = dice < 3 ? kMe : kOther;
        log.act(author, random_edit_near(rng, kOrigin, Extent::cube(8)));
        mark_changes(last_writer, before, log.now(), static_cast<Material>(author));
        continue;
      }
      const bool has_undone = dice < 9 && log.undo().has_value();
      if (dice == 9) log.redo();
      for_each_voxel(before, [&](int x, int y, int z) {
        const bool has_changed = before.at(x, y, z) != log.now().at(x, y, z);
        if (has_changed && last_writer.at(x, y, z) != kMe) REQUIRE(last_writer.at(x, y, z) == kMe);
        if (last_writer.at(x, y, z) == kOther) ++over_others;
      });
      if (!has_undone) continue;
      ++undone;
      if (rng.below(2) == 0) continue;
      // No other edit came in between, so redo restores exactly the voxels that undo took back.
      REQUIRE(log.redo().has_value());
      REQUIRE(log.now() == before);
      ++came_back;
    }
  }
  CHECK(undone > 200);
  CHECK(came_back > 80);
  CHECK(over_others > 1000);
}

TEST_CASE("a voxel that only the player wrote follows the player's stack", "[rollback][property]") {
  SplitMix64 rng{73 + Catch::rngSeed()};
  std::uint64_t compared = 0;
  for (int round = 0; round < 80; ++round) {
    ChunkLog log(small_chunk(rng));
    DenseChunk others(Extent::cube(8));        // 1 where another author ever wrote
    std::vector<EditDescriptor> done, undone;  // the player's actions, newest last
    const DenseChunk start = log.now();
    int skipped = 0;
    for (int step = 0; step < 30 && skipped == 0; ++step) {
      CAPTURE(Catch::rngSeed(), round, step);
      const DenseChunk before = log.now();
      const auto dice = rng.below(8);
      const EditDescriptor edit = random_edit_near(rng, kOrigin, Extent::cube(8));
      if (dice < 2) {
        log.act(kOther, edit);
        mark_changes(others, before, log.now(), 1);
      } else if (dice < 5) {
        log.act(kMe, edit);
        done.push_back(edit);
        undone.clear();
      } else if (dice < 7) {
        if (log.undo(&skipped)) {
          undone.push_back(done.back());
          done.pop_back();
        }
      } else if (log.redo()) {
        done.push_back(undone.back());
        undone.pop_back();
      }
      if (skipped != 0)
        break;  // an older action was undone below a newer one, so the model of a stack ends
      DenseChunk expected = start;
      oracle_apply(expected, kOrigin, done);
      for_each_voxel(start, [&](int x, int y, int z) {
        if (others.at(x, y, z) != 0) return;
        ++compared;
        if (expected.at(x, y, z) != log.now().at(x, y, z)) {
          REQUIRE(expected.at(x, y, z) == log.now().at(x, y, z));
        }
      });
    }
  }
  CHECK(compared > 50'000);
}

}  // namespace runstone::test
