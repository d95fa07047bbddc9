#include "server/world/ground/log_marks.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace runstone {
namespace {

LogMarks refused(const LogMarksRequest& request, std::string why) {
  LogMarks out;
  out.request = request.request;
  out.refusal = std::move(why);
  return out;
}

/// Later marks replace these, so they are skipped if the session's queue is full: the client asks
/// again.
void send_marks(GroundBase& base, const Viewer& viewer, const LogMarks& marks) {
  base.sessions.send_or_skip(viewer.session, encode_message(marks));
}

}  // namespace

/// Returns the names of the authors, as far as they are known.
std::vector<LogAuthor> LogMarkReads::authors_of(const std::vector<LogMark>& marks) const {
  std::set<AuthorId> authors;
  for (const LogMark& mark : marks) authors.insert(mark.author);
  const Players& players = base_.order.players();
  std::vector<LogAuthor> out;
  for (const AuthorId author : authors) {
    const auto key = players.key_of(author);
    const auto name = key ? players.name_of(*key) : std::nullopt;
    if (author != 0 && name && !name->empty()) out.push_back({author, *name});
  }
  return out;
}

void LogMarkReads::read_next(Viewer& viewer, const Clocks& now) {
  LogMarksDue& due = viewer.marks;
  if (!due.next || due.is_reading || now.steady_us < due.due_us || reads_ >= kLogMarkReadsMax)
    return;
  due.due_us = now.steady_us + base_.config.view_interval_us;
  const LogMarksRequest request = *std::exchange(due.next, std::nullopt);
  if (!base_.rights.decide(viewer.session.key, Right::look_back).is_allowed)
    return send_marks(base_, viewer, refused(request, "your role does not allow to see the past"));
  due.is_reading = true;
  ++reads_;
  last_ = viewer.id();
  base_.sessions.charge_reading(viewer.session,
                                request.at ? kVoxelMarkBytes : request.count * kLogMarkBytes);
  base_.environment.read_log_marks(viewer.id(), request);
}

void LogMarkReads::on_request(Viewer& viewer, const LogMarksRequest& request, const Clocks& now) {
  viewer.marks.next = request;
  read_next(viewer, now);
}

void LogMarkReads::read_waiting(const Clocks& now) {
  if (reads_ >= kLogMarkReadsMax) return;
  std::vector<Viewer*> viewers = base_.open();
  // The session behind the last one has the first turn.
  const auto next =
      std::ranges::find_if(viewers, [&](const Viewer* viewer) { return viewer->id() > last_; });
  std::rotate(viewers.begin(), next, viewers.end());
  for (Viewer* viewer : viewers) read_next(*viewer, now);
}

void LogMarkReads::finished(SessionId session, std::uint32_t request,
                            const Result<FoundLogMarks, std::string>& found, const Clocks& now) {
  --reads_;
  Viewer* const viewer = base_.find(session);
  if (viewer == nullptr) return read_waiting(now);
  viewer->marks.is_reading = false;
  if (found) {
    viewer->marks.due_us = std::max(
        viewer->marks.due_us, now.steady_us + static_cast<TimeUs>(found->cost) * kMarkPauseUs);
  }
  LogMarks answer;
  answer.request = request;
  if (found) {
    answer.first = found->first;
    answer.marks = found->marks;
    answer.authors = authors_of(answer.marks);
  } else {
    answer.refusal = found.error();
  }
  send_marks(base_, *viewer, answer);
  read_waiting(now);
}

}  // namespace runstone
