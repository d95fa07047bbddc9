#include "common/core/utc_text.hpp"

#include <algorithm>
#include <cstddef>

namespace runstone {
namespace {

constexpr std::int64_t kSecondUs = 1'000'000;
constexpr std::int64_t kDaySeconds = 86'400;
constexpr std::size_t kDigitsMax = 6;  // of a number in a duration, and behind a decimal point

constexpr std::int64_t floor_to(std::int64_t a, std::int64_t b) {
  return a / b - (a % b < 0 ? 1 : 0);
}

/// Returns the days from 1970-01-01 to a date of the Gregorian calendar. Source: H. Hinnant,
/// "chrono-compatible low-level date algorithms"; years begin in March and eras have 400 years.
constexpr std::int64_t days_of(std::int64_t year, std::int64_t month, std::int64_t day) {
  year -= month <= 2 ? 1 : 0;
  const std::int64_t era = floor_to(year, 400);
  const std::int64_t of_era = year - era * 400;
  const std::int64_t of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return era * 146'097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719'468;
}

struct Date {
  std::int64_t year, month, day;
};
constexpr Date date_of(std::int64_t days) {
  days += 719'468;
  const std::int64_t era = floor_to(days, 146'097);
  const std::int64_t day = days - era * 146'097;
  const std::int64_t year = (day - day / 1460 + day / 36'524 - day / 146'096) / 365;
  const std::int64_t of_year = day - (365 * year + year / 4 - year / 100);
  const std::int64_t month = (5 * of_year + 2) / 153;  // counted from March
  const std::int64_t civil = month < 10 ? month + 3 : month - 9;
  return {year + era * 400 + (civil <= 2 ? 1 : 0), civil, of_year - (153 * month + 2) / 5 + 1};
}

std::string padded(std::int64_t number, std::size_t digits) {
  std::string text = std::to_string(number);
  return text.size() < digits ? std::string(digits - text.size(), '0') + text : text;
}

/// Removes exactly `digits` digits from the front and returns their number, or -1 if they are not
/// there.
std::int64_t take_number(std::string_view& text, std::size_t digits) {
  if (text.size() < digits) return -1;
  std::int64_t number = 0;
  for (const char c : text.substr(0, digits)) {
    if (c < '0' || c > '9') return -1;
    number = number * 10 + (c - '0');
  }
  text.remove_prefix(digits);
  return number;
}

/// Returns the number of digits that the text begins with.
std::size_t digits_of(std::string_view text) {
  return std::min(text.find_first_not_of("0123456789"), text.size());
}

/// Removes one to six decimals of a second from the front and returns them as microseconds, or -1
/// if they are not there.
std::int64_t take_decimals(std::string_view& text) {
  const std::size_t digits = digits_of(text);
  if (digits == 0 || digits > kDigitsMax) return -1;
  std::int64_t us = take_number(text, digits);
  for (std::size_t i = digits; i < kDigitsMax; ++i) us *= 10;
  return us;
}

bool take(std::string_view& text, char c) {
  if (text.empty() || text.front() != c) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

std::string utc_text(TimeUs utc_us) {
  const std::int64_t seconds = floor_to(utc_us, kSecondUs);
  const std::int64_t days = floor_to(seconds, kDaySeconds);
  const std::int64_t of_day = seconds - days * kDaySeconds;
  const Date date = date_of(days);
  return padded(date.year, 4) + "-" + padded(date.month, 2) + "-" + padded(date.day, 2) + "T" +
         padded(of_day / 3600, 2) + ":" + padded(of_day / 60 % 60, 2) + ":" +
         padded(of_day % 60, 2) + "Z";
}

std::optional<TimeUs> parse_utc(std::string_view text) {
  const std::int64_t year = take_number(text, 4);
  if (year < 1970 || !take(text, '-')) return std::nullopt;
  const std::int64_t month = take_number(text, 2);
  if (month < 1 || month > 12 || !take(text, '-')) return std::nullopt;
  const std::int64_t day = take_number(text, 2);
  const std::int64_t days = days_of(year, month, day);
  const Date back = date_of(days);
  if (day < 1 || back.month != month || back.day != day)
    return std::nullopt;  // such as February 30
  std::int64_t hour = 0, minute = 0, second = 0, fraction_us = 0;
  if (take(text, 'T')) {
    hour = take_number(text, 2);
    if (hour < 0 || hour > 23 || !take(text, ':')) return std::nullopt;
    minute = take_number(text, 2);
    if (minute < 0 || minute > 59) return std::nullopt;
    if (take(text, ':')) {
      second = take_number(text, 2);
      if (second < 0 || second > 59) return std::nullopt;
      if (take(text, '.')) fraction_us = take_decimals(text);
      if (fraction_us < 0) return std::nullopt;
    }
    take(text, 'Z');
  }
  if (!text.empty()) return std::nullopt;
  return ((days * 24 + hour) * 3600 + minute * 60 + second) * kSecondUs + fraction_us;
}

std::optional<TimeUs> parse_duration(std::string_view text) {
  constexpr std::string_view kUnits = "wdhms";
  constexpr std::int64_t kSeconds[] = {7 * kDaySeconds, kDaySeconds, 3600, 60, 1};
  std::int64_t seconds = 0;
  // The units that may still follow. Each unit occurs at most once, the longest first.
  std::size_t next = 0;
  do {
    const std::size_t digits = digits_of(text);
    if (digits == 0 || digits > kDigitsMax) return std::nullopt;
    const std::int64_t number = take_number(text, digits);
    const std::size_t unit = text.empty() ? text.npos : kUnits.find(text.front(), next);
    if (unit == text.npos) return std::nullopt;
    text.remove_prefix(1);
    seconds += number * kSeconds[unit];
    next = unit + 1;
  } while (!text.empty());
  return seconds * kSecondUs;
}

}  // namespace runstone
