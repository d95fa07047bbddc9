#include "server/world/preview_handlers.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "protocol/rules/edit_check.hpp"

namespace runstone {
namespace {

// Bytes that count as read, so that messages that gain nothing do not keep the world busy.
constexpr std::size_t kDroppedPreviewBytes = 4'096;

/// Returns true if the edit could be ordered as far as its geometry and its materials say.
bool is_possible(const WorldState& world, WorldSession& mine, const EditDescriptor& edit,
                 const Clocks& now) {
  const WorldConfig& config = world.config;
  if (!is_light_preview(edit, config.chunk_edge)) return false;
  if (world.authority.check(edit)) return false;
  if (config.reach_max == 0) return true;
  const WorldPos& from = mine.position.follow(mine.pose.at, config.speed_max, now.steady_us);
  return within_reach(edit, from, config.reach_max);
}

bool reads_previews(const WorldSession& other, const WorldSession& mine) {
  const bool is_behind = other.stalled_us || !other.pending_rejects.empty();
  return other.state == SessionStage::open && (other.features & kFeaturePreviews) != 0 &&
         !other.history && !is_behind && other.author != mine.author;
}

/// Returns the sessions that see a touched chunk which the sender sees too, ascending.
std::vector<SessionId> viewers(const WorldState& world, SessionId session,
                               const std::vector<EditDescriptor>& edits) {
  std::vector<SessionId> out, merged;
  std::vector<ChunkCoord> touched;
  for (const EditDescriptor& edit : edits) {
    touched_chunks(edit, world.config.chunk_edge, touched);
    for (const ChunkCoord at : touched) {
      const std::span<const SessionId> all = world.interest.subscribers({0, at});
      if (!std::binary_search(all.begin(), all.end(), session)) continue;
      merged.clear();
      std::set_union(out.begin(), out.end(), all.begin(), all.end(), std::back_inserter(merged));
      std::swap(out, merged);
    }
  }
  return out;
}

}  // namespace

void on_preview_share(WorldState& world, SessionId session, const PreviewShare& share,
                      const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (!mine.previews.take(1, now.steady_us))
    return world.output.charge_reading(session, kDroppedPreviewBytes);
  const bool is_live = !mine.history && !mine.is_opening_history;
  const bool are_possible =
      is_live && std::all_of(share.edits.begin(), share.edits.end(),
                             [&](const auto& edit) { return is_possible(world, mine, edit, now); });
  // `waiting` show the preview before, and get none now: the next one comes soon.
  std::vector<SessionId> readers, waiting;
  if (are_possible) {
    for (const SessionId id : viewers(world, session, share.edits)) {
      WorldSession* const other = world.find(id);
      if (readers.size() == kPreviewReadersMax) break;
      if (other == nullptr || !reads_previews(*other, mine)) continue;
      if (other->previews_read.take(1, now.steady_us)) {
        readers.push_back(id);
      } else if (std::binary_search(mine.preview_readers.begin(), mine.preview_readers.end(), id)) {
        waiting.push_back(id);
      }
    }
  } else {
    world.output.charge_reading(session, kDroppedPreviewBytes);
  }
  std::vector<SessionId> showing, gone;
  std::set_union(readers.begin(), readers.end(), waiting.begin(), waiting.end(),
                 std::back_inserter(showing));
  std::set_difference(mine.preview_readers.begin(), mine.preview_readers.end(), showing.begin(),
                      showing.end(), std::back_inserter(gone));
  std::erase_if(gone, [&](SessionId id) {
    const WorldSession* const other = world.find(id);
    return other == nullptr || other->state != SessionStage::open;
  });
  const auto pass_on = [&](const std::vector<SessionId>& to, const PlayerPreview& preview) {
    if (to.empty()) return;
    const EncodedMessage encoded = encode_message(preview);
    world.counters.queue_full += world.output.send_to_all(to, encoded).size();
    world.output.charge_reading(session, to.size() * encoded.bytes->size());
  };
  pass_on(gone, {mine.author, {}});
  pass_on(readers, {mine.author, share.edits});
  mine.preview_readers = std::move(showing);
}

}  // namespace runstone
