#include "server/rollback/rollback_groups.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace runstone {

StoreResult<RollbackGroup> rollback_group(LogReader& reader, Sequence id) {
  RollbackGroup group;
  bool begins = false;
  const auto first = reader.read_log(id, id, [&](const EditRecord& record) {
    const bool is_server_edit = record.cause == Cause::rollback || record.cause == Cause::undo ||
                                record.cause == Cause::redo;
    begins = is_server_edit && record.op.seq == kGroupBegins;
    group.id = id;
    group.op = record.op;
    group.cause = record.cause;
    group.time_us = record.time_us;
    return true;
  });
  if (!first) return failure(first.error());
  if (!begins) {
    return failure(StoreError{StoreError::Kind::bad_request, reader.file(),
                              "edit_log seq=" + std::to_string(id), "no rollback begins there"});
  }
  LogQuery query;
  query.author = group.op.author;
  query.cause = group.cause;
  query.first = id;
  const auto read = reader.query_log(query, [&](const EditRecord& record) {
    if (record.op.instance == group.op.instance) group.edits.push_back(record.version.seq);
    return true;
  });
  if (!read) return failure(read.error());
  return group;
}

namespace {

using GroupKey = std::pair<AuthorId, ClientInstance>;

/// The rollbacks of a log and the undos of them.
struct Groups {
  std::map<GroupKey, RollbackGroup> rollbacks, undos;
  std::map<Sequence, Sequence> group_of;  // id, by edit
};

RollbackGroup& add(Groups& groups, std::map<GroupKey, RollbackGroup>& kind,
                   const EditRecord& record) {
  RollbackGroup& group = kind[{record.op.author, record.op.instance}];
  if (group.id == 0) {
    group.id = record.version.seq;
    group.op = record.op;
    group.cause = record.cause;
    group.time_us = record.time_us;
  }
  group.edits.push_back(record.version.seq);
  groups.group_of[record.version.seq] = group.id;
  return group;
}

StoreResult<Groups> read_groups(LogReader& reader) {
  Groups groups;
  LogQuery query;
  query.cause = Cause::rollback;
  auto read = reader.query_log(query, [&](const EditRecord& record) {
    add(groups, groups.rollbacks, record);
    return true;
  });
  if (!read) return failure(read.error());
  query.cause = Cause::undo;
  read = reader.query_log(query, [&](const EditRecord& record) {
    // An undo of a player is no group: nothing begins it.
    const bool begins = record.op.seq == kGroupBegins;
    const bool is_in_group =
        begins || groups.undos.contains({record.op.author, record.op.instance});
    if (!is_in_group) return true;
    const auto subject = groups.group_of.find(record.subject);
    RollbackGroup& undo = add(groups, groups.undos, record);
    if (subject != groups.group_of.end()) undo.takes_back = subject->second;
    return true;
  });
  if (!read) return failure(read.error());
  return groups;
}

/// Returns the undos in force by the group that they take back: those that no undo in force takes
/// back in turn. Of several for one group the newest is kept.
std::map<Sequence, Sequence> undos_in_force(const Groups& groups) {
  std::map<Sequence, Sequence> target_of;  // by id
  for (const auto& [key, undo] : groups.undos) {
    if (undo.takes_back != 0) target_of[undo.id] = undo.takes_back;
  }
  std::map<Sequence, Sequence> taken_back_by;
  // An undo is newer than what it takes back, so it is decided before it.
  for (auto undo = target_of.rbegin(); undo != target_of.rend(); ++undo) {
    if (!taken_back_by.contains(undo->first)) taken_back_by.try_emplace(undo->second, undo->first);
  }
  return taken_back_by;
}

}  // namespace

StoreResult<std::vector<RollbackGroup>> rollback_groups(LogReader& reader, std::size_t count_max,
                                                        std::optional<AuthorId> author) {
  auto groups = read_groups(reader);
  if (!groups) return failure(groups.error());
  const std::map<Sequence, Sequence> taken_back_by = undos_in_force(*groups);
  std::vector<RollbackGroup> out;
  out.reserve(groups->rollbacks.size());
  for (auto& [key, group] : groups->rollbacks) {
    if (author && group.op.author != *author) continue;
    if (const auto by = taken_back_by.find(group.id); by != taken_back_by.end())
      group.taken_back_by = by->second;
    out.push_back(std::move(group));
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  if (out.size() > count_max)
    out.erase(out.begin(), out.end() - static_cast<std::ptrdiff_t>(count_max));
  return out;
}

}  // namespace runstone
