#include "client/session/log_timeline.hpp"

#include <algorithm>
#include <set>

namespace runstone {
namespace {

bool is_within(const std::optional<TimeUs>& since_us, TimeUs span_us, TimeUs now_us) {
  return since_us && now_us - *since_us < span_us;
}

}  // namespace

LogMarksRequest LogTimeline::send(Kind kind, Sequence first, Sequence last, std::uint8_t count,
                                  TimeUs now_us) {
  pending_ = Pending{++requests_, kind, now_us};
  return {requests_, first, last, count};
}

std::optional<LogMarksRequest> LogTimeline::next_request(Sequence newest, Sequence shown,
                                                         TimeUs now_us) {
  if (pending_ && now_us - pending_->sent_us >= kAnswerUsMax) pending_.reset();
  if (pending_ || newest == 0 || is_within(refused_us_, kRefusedUs, now_us)) return std::nullopt;
  const Sequence growth = newest - std::min(newest, band_newest_);
  const bool has_grown = growth >= std::max<Sequence>(1, newest / kGrowthShare);
  if (has_grown && !is_within(band_us_, kBandEveryUs, now_us)) {
    band_us_ = now_us;
    band_newest_ = newest;
    return send(Kind::band, 1, newest, kBandMarks, now_us);
  }
  if (recent_end_ != shown && !is_within(recent_us_, kRecentEveryUs, now_us)) {
    recent_us_ = now_us;
    recent_end_ = shown;
    if (shown == 0) {
      recent_.clear();
      return std::nullopt;
    }
    const Sequence first = shown < kRecentMarks ? 1 : shown - kRecentMarks + 1;
    const auto count = static_cast<std::uint8_t>(shown - first + 1);
    return send(Kind::recent, first, shown, count, now_us);
  }
  return std::nullopt;
}

bool LogTimeline::receive(const LogMarks& marks, TimeUs now_us) {
  if (!pending_ || pending_->request != marks.request) return false;
  const Kind kind = pending_->kind;
  pending_.reset();
  refusal_ = marks.refusal;
  if (!refusal_.empty()) {
    refused_us_ = now_us;
    band_newest_ = 0;
    recent_end_.reset();
    return true;
  }
  for (const LogAuthor& author : marks.authors) names_[author.author] = author.name;
  first_ = marks.first;
  (kind == Kind::band ? band_ : recent_) = marks.marks;
  std::set<AuthorId> shown;
  for (const auto* list : {&band_, &recent_}) {
    for (const LogMark& mark : *list) shown.insert(mark.author);
  }
  std::erase_if(names_, [&](const auto& name) { return !shown.contains(name.first); });
  return true;
}

void LogTimeline::disconnected() {
  // Sequences stay valid, because a world loses only edits that were not on disk.
  pending_.reset();
  requests_ = 0;
  refused_us_.reset();
  band_newest_ = 0;
  recent_end_.reset();
}

std::string LogTimeline::name_of(AuthorId author) const {
  if (author == 0) return "the server";
  const auto found = names_.find(author);
  return found == names_.end() ? "#" + std::to_string(author) : found->second;
}

}  // namespace runstone
