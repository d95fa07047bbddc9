#include "server/map/map_builders.hpp"

#include "common/core/key_text.hpp"
#include "common/core/utc_text.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/rollback/newest_edits.hpp"

namespace runstone {
namespace {

// The edits that are looked at in one search, and the searches. Their bounding boxes meet the column,
// and their voxels may not.
constexpr std::size_t kLookEdits = 256;
constexpr int kLooks = 8;

/// Returns the time with its microseconds, in the form of parse_utc().
std::string exact_utc(TimeUs utc_us) {
  constexpr TimeUs kUsPerSecond = 1'000'000;
  std::string text = utc_text(utc_us);
  text.pop_back();  // Z
  const TimeUs rest = ((utc_us % kUsPerSecond) + kUsPerSecond) % kUsPerSecond;
  const std::string digits = std::to_string(kUsPerSecond + rest).substr(1);
  return text + "." + digits + "Z";
}

}  // namespace

StoreResult<std::vector<EditRecord>> newest_edits_of_column(LogReader& reader, std::int32_t x,
                                                            std::int32_t z, Sequence last) {
  SelectionFilter filter;
  filter.box = VoxelBox{{x, -kWorldLimit, z}, {x + 1, kWorldLimit, z + 1}};
  filter.last = last;
  std::vector<EditRecord> out;
  for (int look = 0; look < kLooks; ++look) {
    const auto found = newest_edits(reader, filter, kLookEdits);
    if (!found) return found;
    for (auto at = found->rbegin(); at != found->rend() && out.size() < kBuildersMax; ++at) {
      if (changes_voxels(at->cause) && touches(at->edit, *filter.box)) out.push_back(*at);
    }
    if (out.size() == kBuildersMax || found->size() < kLookEdits) break;
    filter.last = found->front().version.seq - 1;
  }
  return out;
}

StoreResult<std::vector<EditRecord>> newest_edits_of_world(LogReader& reader) {
  auto found = newest_edits(reader, {}, 4 * kBuildersMax);
  if (!found) return found;
  std::vector<EditRecord> out;
  for (auto at = found->rbegin(); at != found->rend() && out.size() < kBuildersMax; ++at) {
    if (changes_voxels(at->cause)) out.push_back(*at);
  }
  return out;
}

std::string undo_command(const EditRecord& record) {
  const VoxelBox box = bounding_box(record.edit);
  const std::string time = exact_utc(record.time_us);
  // The server is no player, so its edits are found by time and place alone.
  const std::string author =
      record.op.author == 0 ? "" : " author #" + std::to_string(record.op.author);
  return "rollback preview" + author + " since " + time + " until " + time + " box " +
         text_of(box.min) + " " + text_of(VoxelPos{box.max.x - 1, box.max.y - 1, box.max.z - 1});
}

}  // namespace runstone
