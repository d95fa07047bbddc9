#include "server/world/log_mark_handlers.hpp"

#include <set>
#include <utility>

#include "common/rights/right.hpp"
#include "server/world/rights_handlers.hpp"

namespace runstone {
namespace {

/// Later marks replace these, so they are skipped if the session's queue is full: the client asks
/// again.
void send_marks(WorldState& world, SessionId session, const LogMarks& marks) {
  send_or_skip(world, session, encode_message(marks));
}

LogMarks refused(const LogMarksRequest& request, std::string why) {
  LogMarks out;
  out.request = request.request;
  out.refusal = std::move(why);
  return out;
}

/// Returns the names of the authors, as far as they are known.
std::vector<LogAuthor> authors_of(const WorldState& world, const std::vector<LogMark>& marks) {
  std::set<AuthorId> authors;
  for (const LogMark& mark : marks) authors.insert(mark.author);
  std::vector<LogAuthor> out;
  for (const AuthorId author : authors) {
    const auto key = world.players.key_of(author);
    const auto name = key ? world.players.name_of(*key) : std::nullopt;
    if (author != 0 && name && !name->empty()) out.push_back({author, *name});
  }
  return out;
}

void read_next(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (!mine.next_log_marks || mine.is_reading_log_marks || now.steady_us < mine.log_marks_due_us ||
      world.log_mark_reads >= kLogMarkReadsMax)
    return;
  mine.log_marks_due_us = now.steady_us + world.config.view_interval_us;
  const LogMarksRequest request = *std::exchange(mine.next_log_marks, std::nullopt);
  if (!decide(world, mine.key, Right::look_back).is_allowed)
    return send_marks(world, session, refused(request, "your role does not allow to see the past"));
  mine.is_reading_log_marks = true;
  ++world.log_mark_reads;
  world.output.charge_reading(session, request.count * kLogMarkBytes);
  world.environment.read_log_marks(session, request);
}

}  // namespace

void on_log_marks_request(WorldState& world, SessionId session, const LogMarksRequest& request,
                          const Clocks& now) {
  world.find(session)->next_log_marks = request;
  read_next(world, session, now);
}

void read_waiting_log_marks(WorldState& world, const Clocks& now) {
  for (const SessionId id : world.open_sessions()) {
    if (world.log_mark_reads >= kLogMarkReadsMax) return;
    read_next(world, id, now);
  }
}

void on_log_marks_read(WorldState& world, SessionId session, std::uint32_t request,
                       const Result<FoundLogMarks, std::string>& found, const Clocks& now) {
  --world.log_mark_reads;
  WorldSession* const mine = world.find(session);
  if (mine == nullptr) return;
  mine->is_reading_log_marks = false;
  LogMarks answer;
  answer.request = request;
  if (found) {
    answer.first = found->first;
    answer.marks = found->marks;
    answer.authors = authors_of(world, answer.marks);
  } else {
    answer.refusal = found.error();
  }
  send_marks(world, session, answer);
  read_next(world, session, now);
}

}  // namespace runstone
