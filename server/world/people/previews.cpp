#include "server/world/people/previews.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "protocol/rules/edit_check.hpp"
#include "server/world/people/reach.hpp"

namespace runstone {
namespace {

// Bytes that count as read, so that messages that gain nothing do not keep the world busy.
constexpr std::size_t kDroppedPreviewBytes = 4'096;
/// The work of a stroke at its viewers that counts as one byte read.
constexpr std::uint64_t kStrokeWorkPerByte = 256;

}  // namespace

/// Returns true if the edit could be ordered as far as its geometry and its materials say.
bool Previews::is_possible(Session& session, const EditDescriptor& edit, const Clocks& now) const {
  return is_light_preview(edit, config_.chunk_edge) && !order_.authority().check(edit) &&
         is_within_reach(config_, session, edit, now);
}

/// Returns true if the stroke could be made as far as its places, its work and its materials say.
bool Previews::is_possible(Session& session, const BrushStroke& stroke, const Clocks& now) const {
  return check_stroke(stroke) && std::ranges::all_of(stroke.places, [&](const VoxelPos& at) {
           return is_possible(session, {SetVoxel{at}, stroke.mask, stroke.material}, now);
         });
}

bool Previews::reads_previews(const Session& other, const Session& sender) const {
  if (!other.is_open() || !other.has(kFeaturePreviews) || other.author == sender.author)
    return false;
  const bool is_behind = ground_.lags(other) || receipts_.has_pending(other);
  return !is_behind && !ground_.sees_past(other);
}

/// Returns the sessions that see a touched chunk which the sender sees too, ascending.
std::vector<SessionId> Previews::viewers(SessionId session,
                                         const std::vector<EditDescriptor>& edits) const {
  std::vector<SessionId> out, merged;
  std::vector<ChunkCoord> touched;
  for (const EditDescriptor& edit : edits) {
    touched_chunks(edit, config_.chunk_edge, touched);
    for (const ChunkCoord at : touched) {
      const std::span<const SessionId> all = ground_.subscribers({0, at});
      if (!std::binary_search(all.begin(), all.end(), session)) continue;
      merged.clear();
      std::set_union(out.begin(), out.end(), all.begin(), all.end(), std::back_inserter(merged));
      std::swap(out, merged);
    }
  }
  return out;
}

void Previews::pass_on(const Session& sender, const std::vector<SessionId>& to,
                       const PlayerPreview& preview) {
  if (to.empty()) return;
  const EncodedMessage encoded = encode_message(preview);
  sessions_.send_to_all(to, encoded);
  sessions_.charge_reading(sender, to.size() * encoded.bytes->size());
}

void Previews::on_share(Session& session, const PreviewShare& share, const Clocks& now) {
  SessionPreviews& mine = by_session_[session.id];
  if (!mine.sent.take(1, now.steady_us))
    return sessions_.charge_reading(session, kDroppedPreviewBytes);
  const bool are_possible =
      ground_.sees_present(session) && std::ranges::all_of(share.edits, [&](const auto& edit) {
        return is_possible(session, edit, now);
      });
  // A client without the feature gets the edits only.
  const bool has_stroke = are_possible && share.stroke && session.has(kFeatureStrokes) &&
                          is_possible(session, *share.stroke, now);
  if (share.stroke) {
    sessions_.charge_reading(
        session, has_stroke
                     ? static_cast<std::size_t>(stroke_work(*share.stroke) / kStrokeWorkPerByte)
                     : kDroppedPreviewBytes);
  }
  // `waiting` show the preview before, and get none now: the next one comes soon.
  std::vector<SessionId> readers, waiting;
  if (are_possible) {
    for (const SessionId id : viewers(session.id, share.edits)) {
      const Session* const other = sessions_.find(id);
      if (readers.size() == kPreviewReadersMax) break;
      if (other == nullptr || !reads_previews(*other, session)) continue;
      if (by_session_[id].read.take(1, now.steady_us)) {
        readers.push_back(id);
      } else if (std::ranges::binary_search(mine.readers, id)) {
        waiting.push_back(id);
      }
    }
  } else {
    sessions_.charge_reading(session, kDroppedPreviewBytes);
  }
  std::vector<SessionId> showing, gone;
  std::ranges::set_union(readers, waiting, std::back_inserter(showing));
  std::ranges::set_difference(mine.readers, showing, std::back_inserter(gone));
  std::erase_if(gone, [&](SessionId id) {
    const Session* const other = sessions_.find(id);
    return other == nullptr || !other->is_open();
  });
  pass_on(session, gone, {session.author, {}});
  if (has_stroke) {
    const auto first_without = std::stable_partition(
        readers.begin(), readers.end(),
        [&](SessionId id) { return sessions_.find(id)->has(kFeatureStrokes); });
    const std::vector<SessionId> with(readers.begin(), first_without);
    pass_on(session, with, {session.author, share.edits, share.stroke});
    readers.erase(readers.begin(), first_without);
  }
  pass_on(session, readers, {session.author, share.edits});
  mine.readers = std::move(showing);
}

}  // namespace runstone
