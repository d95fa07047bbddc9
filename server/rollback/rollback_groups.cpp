#include "server/rollback/rollback_groups.hpp"

#include <algorithm>
#include <map>
#include <optional>
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

StoreResult<std::vector<RollbackGroup>> rollback_groups(LogReader& reader, std::size_t count_max) {
  std::map<std::pair<AuthorId, ClientInstance>, RollbackGroup> by_instance;
  std::map<Sequence, std::pair<AuthorId, ClientInstance>> group_of;  // by edit
  LogQuery query;
  query.cause = Cause::rollback;
  auto read = reader.query_log(query, [&](const EditRecord& record) {
    const std::pair instance{record.op.author, record.op.instance};
    RollbackGroup& group = by_instance[instance];
    if (group.id == 0) {
      group.id = record.version.seq;
      group.op = record.op;
      group.time_us = record.time_us;
    }
    group.edits.push_back(record.version.seq);
    group_of[record.version.seq] = instance;
    return true;
  });
  if (!read) return failure(read.error());
  query.cause = Cause::undo;
  std::optional<OperationId> undo;
  Sequence undo_id = 0;
  read = reader.query_log(query, [&](const EditRecord& record) {
    if (record.op.seq == kGroupBegins) {
      undo = record.op;
      undo_id = record.version.seq;
    }
    const auto answered = group_of.find(record.subject);
    if (answered != group_of.end() && undo && undo->instance == record.op.instance) {
      by_instance[answered->second].taken_back_by = undo_id;
    }
    return true;
  });
  if (!read) return failure(read.error());
  std::vector<RollbackGroup> out;
  out.reserve(by_instance.size());
  for (auto& [instance, group] : by_instance) out.push_back(std::move(group));
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  if (out.size() > count_max)
    out.erase(out.begin(), out.end() - static_cast<std::ptrdiff_t>(count_max));
  return out;
}

}  // namespace runstone
