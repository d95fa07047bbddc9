// LogTimeline: the records of the log that the timeline shows: marks over all of the log, and the
// last edits up to the shown moment. It decides when marks are requested from the server, so that
// the timeline follows a world in use without much traffic. One request is under way at a time.
// Pure: times are arguments, in microseconds of the client's steady clock. One thread.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "protocol/codec/messages.hpp"

namespace runstone {

/// The greatest sequence that timelines compute with. A greater one can only come from a server
/// that is broken.
inline constexpr Sequence kSequenceShownMax = Sequence{1} << 53;

class LogTimeline {
 public:
  static constexpr std::uint8_t kBandMarks = 128;  // over all of the log
  static constexpr std::uint8_t kRecentMarks = 10;
  /// The least time between two requests for each kind of marks, and after a refusal.
  static constexpr TimeUs kBandEveryUs = 5'000'000, kRecentEveryUs = 400'000;
  static constexpr TimeUs kRefusedUs = 10'000'000;
  /// An answer that has not arrived within this time counts as lost.
  static constexpr TimeUs kAnswerUsMax = 10'000'000;
  /// The band is requested again when the log has grown by one part in this many.
  static constexpr Sequence kGrowthShare = 64;

  /// Returns the request to send now, or nullopt. `newest` is the last edit of the log, `shown`
  /// that of the shown moment; 0: before the first one. Call it while the timeline is on the
  /// screen.
  std::optional<LogMarksRequest> next_request(Sequence newest, Sequence shown, TimeUs now_us);
  /// Takes an answer of the server. Answers to other requests than the last one change nothing.
  /// Returns true if what the timeline shows has changed.
  bool receive(const LogMarks& marks, TimeUs now_us);
  /// Notes why there will be no marks.
  void refuse(std::string why) { refusal_ = std::move(why); }
  /// Forgets everything, because the next world is another one.
  void clear() { *this = {}; }
  /// Forgets the request under way, because its connection ended.
  void disconnected();

  /// Returns true if a request is under way.
  bool is_waiting() const { return pending_.has_value(); }
  /// Returns the first edit of the log; earlier ones were compacted away.
  Sequence first() const { return first_; }
  /// Returns marks over the log, ascending by seq.
  const std::vector<LogMark>& band() const { return band_; }
  /// Returns the edits that end at the shown moment, ascending by seq; kRecentMarks at most.
  const std::vector<LogMark>& recent() const { return recent_; }
  /// Returns the name of an author, as far as the server sent it; "the server" for 0, otherwise
  /// "#N".
  std::string name_of(AuthorId author) const;
  /// Returns why the server sends no marks, or an empty text.
  const std::string& refusal() const { return refusal_; }

 private:
  enum class Kind : std::uint8_t { band, recent };
  struct Pending {
    std::uint32_t request = 0;
    Kind kind = Kind::band;
    TimeUs sent_us = 0;
  };
  LogMarksRequest send(Kind kind, Sequence first, Sequence last, std::uint8_t count, TimeUs now_us);

  std::uint32_t requests_ = 0;  // of this connection
  std::optional<Pending> pending_;
  Sequence first_ = 1;
  std::vector<LogMark> band_, recent_;
  std::map<AuthorId, std::string> names_;
  std::string refusal_;
  std::optional<TimeUs> refused_us_, band_us_, recent_us_;  // when it was refused or asked for last
  Sequence band_newest_ = 0;  // the end of the log when the band was asked for last
  std::optional<Sequence> recent_end_;
};

}  // namespace runstone
