#include "client/play/time_travel.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>

namespace runstone {
namespace {

/// The log is divided into this many steps.
constexpr Sequence kSteps = 100;

}  // namespace

void show_after(ClientSession& session, Sequence seq) {
  HistoryRequest request;  // the live world
  if (seq < shown_sequence(session).newest) {
    request.to = HistoryTarget::sequence;
    request.seq = seq;
  }
  static_cast<void>(session.request_history(request));
}

void step_in_time(ClientSession& session, int steps) {
  const ShownSequence now = shown_sequence(session);
  Sequence from = now.shown;
  if (session.loading_history()) {
    const HistoryRequest& requested = session.history_request();
    from = requested.to == HistoryTarget::sequence ? requested.seq : now.newest;
  }
  const auto step = static_cast<std::int64_t>(std::max<Sequence>(1, now.newest / kSteps));
  const auto start = static_cast<std::int64_t>(std::min(from, now.newest));
  show_after(session, static_cast<Sequence>(std::max<std::int64_t>(0, start + steps * step)));
}

ShownSequence shown_sequence(const ClientSession& session) {
  const Replica& replica = session.replica();
  const Sequence newest = std::min(replica.newest(), kSequenceShownMax);
  const auto& past = replica.past();
  return {newest, past ? std::min(past->seq, kSequenceShownMax) : newest};
}

std::string moment_text(const std::optional<PastMoment>& past) {
  if (!past) return {};
  std::string out = "the past: after edit " + std::to_string(past->seq);
  if (past->utc_us == 0) return out;
  // A time_t has 32 bits in a browser.
  const std::chrono::sys_time<std::chrono::microseconds> at{
      std::chrono::microseconds(past->utc_us)};
  const auto day = std::chrono::floor<std::chrono::days>(at);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(std::chrono::floor<std::chrono::seconds>(at - day));
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), " (%04d-%02u-%02u %02d:%02d:%02d UTC)",
                static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                static_cast<unsigned>(date.day()), static_cast<int>(time.hours().count()),
                static_cast<int>(time.minutes().count()), static_cast<int>(time.seconds().count()));
  return out + text.data();
}

}  // namespace runstone
