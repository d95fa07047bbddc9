#include "server/rollback/newest_actions.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/rollback/log_windows.hpp"

namespace runstone {
namespace {

VoxelBox around(const VoxelBox& a, const VoxelBox& b) {
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
}

/// The records of one action have one key.
using ActionKey = std::tuple<AuthorId, Cause, Sequence>;

ActionKey key_of(const EditRecord& record) {
  const bool is_of_action =
      record.cause == Cause::player || record.cause == Cause::undo || record.cause == Cause::redo;
  const Sequence first = is_of_action && record.subject != 0 ? record.subject : record.version.seq;
  return {record.op.author, record.cause, first};
}

}  // namespace

StoreResult<std::vector<LogAction>> newest_actions(LogReader& reader, const SelectionFilter& filter,
                                                   std::size_t count_max) {
  std::map<ActionKey, LogAction> found;
  std::size_t read_count = 0;
  const auto wants_more = [&] {
    return found.size() < count_max && read_count < kActionRecordsMax;
  };
  const auto read = read_log_backwards(reader, filter, wants_more, [&](const EditRecord& record) {
    ++read_count;
    LogAction& action = found[key_of(record)];
    const VoxelBox box = bounding_box(record.edit);
    action.box = action.edits++ == 0 ? box : around(action.box, box);
    if (action.first == 0 || record.version.seq < action.first) action.first = record.version.seq;
    if (record.version.seq > action.newest.version.seq) action.newest = record;
  });
  if (!read) return failure(read.error());
  std::vector<LogAction> out;
  out.reserve(found.size());
  for (auto& [key, action] : found) out.push_back(std::move(action));
  std::sort(out.begin(), out.end(), [](const LogAction& a, const LogAction& b) {
    return a.newest.version.seq < b.newest.version.seq;
  });
  if (out.size() > count_max)
    out.erase(out.begin(), out.end() - static_cast<std::ptrdiff_t>(count_max));
  return out;
}

}  // namespace runstone
