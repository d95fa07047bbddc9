#include "server/history/named_moment.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

namespace runstone {

namespace {

constexpr TimeUs kSecond = 1'000'000;

/// Takes what it reads from the front of a text.
class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}
  bool at_end() const { return text_.empty(); }
  bool take(char c) {
    if (text_.empty() || text_.front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  /// Decimal digits, as many as there are, at least one and `most` at most.
  std::optional<std::uint64_t> number(std::size_t most) {
    std::size_t count = 0;
    while (count < text_.size() && text_[count] >= '0' && text_[count] <= '9') ++count;
    if (count == 0 || count > most) return std::nullopt;
    const std::string_view digits = text_.substr(0, count);
    std::uint64_t value = 0;
    if (std::from_chars(digits.data(), digits.data() + digits.size(), value).ec != std::errc()) {
      return std::nullopt;
    }
    digits_ = count;
    text_.remove_prefix(count);
    return value;
  }
  /// Exactly so many digits, `low` to `high`.
  std::optional<unsigned> fixed(std::size_t digits, unsigned low, unsigned high) {
    const auto value = number(digits);
    if (!value || digits_ != digits || *value < low || *value > high) return std::nullopt;
    return static_cast<unsigned>(*value);
  }
  std::size_t digits() const { return digits_; }

 private:
  std::string_view text_;
  std::size_t digits_ = 0;  // of the last number
};

std::optional<TimeUs> parse_duration(Reader in) {
  constexpr std::array<std::pair<char, TimeUs>, 4> kUnits = {
      {{'d', 86'400 * kSecond}, {'h', 3'600 * kSecond}, {'m', 60 * kSecond}, {'s', kSecond}}};
  TimeUs sum = 0;
  for (std::size_t next = 0; next == 0 || !in.at_end();) {
    const auto value = in.number(6);
    if (!value) return std::nullopt;
    std::size_t unit = next;
    while (unit < kUnits.size() && !in.take(kUnits[unit].first)) ++unit;
    if (unit == kUnits.size()) return std::nullopt;
    sum += static_cast<TimeUs>(*value) * kUnits[unit].second;
    next = unit + 1;
  }
  return sum;
}

std::optional<TimeUs> parse_time(Reader in) {
  const auto year = in.fixed(4, 1970, 9999);
  if (!year || !in.take('-')) return std::nullopt;
  const auto month = in.fixed(2, 1, 12);
  if (!month || !in.take('-')) return std::nullopt;
  const auto day = in.fixed(2, 1, 31);
  if (!day || !in.take('T')) return std::nullopt;
  const auto hour = in.fixed(2, 0, 23);
  if (!hour || !in.take(':')) return std::nullopt;
  const auto minute = in.fixed(2, 0, 59);
  if (!minute) return std::nullopt;
  TimeUs us = 0;
  if (in.take(':')) {
    const auto second = in.fixed(2, 0, 59);
    if (!second) return std::nullopt;
    us = TimeUs{*second} * kSecond;
    if (in.take('.')) {
      const auto fraction = in.number(6);
      if (!fraction) return std::nullopt;
      TimeUs scaled = static_cast<TimeUs>(*fraction);
      for (std::size_t i = in.digits(); i < 6; ++i) scaled *= 10;
      us += scaled;
    }
  }
  if (!in.take('Z') || !in.at_end()) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(*year)),
                                         std::chrono::month(*month), std::chrono::day(*day)};
  if (!date.ok()) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((days * 24 + *hour) * 60 + *minute) * 60 * kSecond + us;
}

}  // namespace

Result<NamedMoment, std::string> parse_moment(std::string_view text) {
  const auto wrong = [&] {
    return Unexpected<std::string>{
        "\"" + std::string(text) +
        "\" is no moment: write a sequence (9120), a time in UTC (2026-11-21T23:05:00Z) or a "
        "time before the end of the log (-2h30m)"};
  };
  if (text.starts_with('-')) {
    const auto duration = parse_duration(Reader(text.substr(1)));
    if (!duration) return wrong();
    return NamedMoment(BeforeEnd{*duration});
  }
  Reader in(text);
  if (const auto sequence = in.number(19); sequence && in.at_end()) {
    if (*sequence > kSequenceMax) return wrong();
    return NamedMoment(Sequence{*sequence});
  }
  const auto time = parse_time(Reader(text));
  if (!time) return wrong();
  return NamedMoment(AtTime{*time});
}

StoreResult<Sequence> sequence_of(Store& reader, const NamedMoment& moment) {
  const auto range = reader.log_range();
  if (!range) return Unexpected<StoreError>{range.error()};
  const auto refuse = [&](std::string what) {
    return Unexpected<StoreError>{
        {StoreError::Kind::bad_request, reader.file(), "edit_log", std::move(what)}};
  };
  if (const auto* sequence = std::get_if<Sequence>(&moment)) {
    if (*sequence + 1 < range->first) {
      return refuse("begins at seq=" + std::to_string(range->first) + ": seq=" + std::to_string(*sequence) +
                    " was compacted away");
    }
    if (*sequence <= range->last.version.seq) return *sequence;
    return refuse("ends at seq=" + std::to_string(range->last.version.seq) +
                  ", before seq=" + std::to_string(*sequence));
  }
  const auto* before_end = std::get_if<BeforeEnd>(&moment);
  // No overflow: durations are short, and a damaged time is not earlier than the beginning of time.
  const TimeUs last = range->last.time_us;
  TimeUs us = before_end != nullptr ? 0 : std::get_if<AtTime>(&moment)->us;
  if (before_end != nullptr) {
    const TimeUs earliest = std::numeric_limits<TimeUs>::min();
    us = last < earliest + before_end->us ? earliest : last - before_end->us;
  }
  return reader.sequence_at(us);
}

}  // namespace runstone
