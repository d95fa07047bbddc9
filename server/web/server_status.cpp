#include "server/web/server_status.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace runstone {
namespace {

/// Returns the text up to `end` and removes both from `text`. Without `end` it returns all of it.
std::string_view take_until(std::string_view& text, char end) {
  const std::size_t at = text.find(end);
  const std::string_view taken = text.substr(0, at);
  text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
  return taken;
}

void read_counters(std::string_view fields, std::map<std::string, std::int64_t>& out) {
  while (!fields.empty()) {
    std::string_view field = take_until(fields, ' ');
    const std::string name(take_until(field, '='));
    const std::string value(field);
    std::int64_t number = 0;
    const char* end = value.data() + value.size();
    const auto [rest, error] = std::from_chars(value.data(), end, number);
    if (error == std::errc{} && rest == end && !name.empty()) out[name] = number;
  }
}

/// Reads "X Y Z NAME". Returns nullopt on any other text.
std::optional<PlayerPlace> read_place(std::string_view text) {
  PlayerPlace out;
  for (double* number : {&out.x, &out.y, &out.z}) {
    const std::string_view word = take_until(text, ' ');
    const char* end = word.data() + word.size();
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), *number);
    if (error != std::errc{} || rest != end || !std::isfinite(*number)) return std::nullopt;
  }
  out.name = text;
  return out;
}

/// Reads "box X Z X Z" or "circle X Z RADIUS". Returns nullopt on any other text.
std::optional<StatusBorder> read_border(std::string_view text) {
  StatusBorder out;
  const std::string_view form = take_until(text, ' ');
  out.is_circle = form == "circle";
  if (!out.is_circle && form != "box") return std::nullopt;
  for (std::size_t i = 0; i < (out.is_circle ? 3U : 4U); ++i) {
    const std::string_view word = take_until(text, ' ');
    const char* end = word.data() + word.size();
    const auto [rest, error] = std::from_chars(word.data(), end, out.numbers[i]);
    if (error != std::errc{} || rest != end || word.empty()) return std::nullopt;
  }
  return text.empty() ? std::optional(out) : std::nullopt;
}

}  // namespace

std::int64_t ServerStatus::counter(const std::string& name) const {
  const auto found = counters.find(name);
  return found == counters.end() ? 0 : found->second;
}

std::vector<EditWaits> edit_waits(const ServerStatus& status, std::string_view name) {
  const std::string prefix = std::string(name) + "_ms_le_";
  std::vector<EditWaits> out;
  for (const auto& [counter, value] : status.counters) {
    if (!counter.starts_with(prefix) || value < 0) continue;
    EditWaits waits{0, static_cast<std::uint64_t>(value)};
    const char* end = counter.data() + counter.size();
    const auto [rest, error] = std::from_chars(counter.data() + prefix.size(), end, waits.ms_max);
    if (error == std::errc{} && rest == end) out.push_back(waits);
  }
  std::ranges::sort(out, {}, &EditWaits::ms_max);
  return out;
}

Result<ServerStatus> parse_server_status(std::string_view answer) {
  constexpr std::string_view kCounters = "|counters ", kPlayer = "|player ", kPlace = "|place ";
  constexpr std::string_view kVersionLine = "|version ", kReadOnly = "|read_only ";
  constexpr std::string_view kBorder = "|border ";
  ServerStatus out;
  while (!answer.empty()) {
    std::string_view line = take_until(answer, '\n');
    if (line == "=ok") {
      out.is_up = true;
      return out;
    }
    if (line.starts_with(kCounters)) {
      read_counters(line.substr(kCounters.size()), out.counters);
    } else if (line.starts_with(kVersionLine)) {
      out.version = line.substr(kVersionLine.size());
    } else if (line.starts_with(kReadOnly)) {
      out.read_only = line.substr(kReadOnly.size());
    } else if (line.starts_with(kPlayer)) {
      out.players.emplace_back(line.substr(kPlayer.size()));
    } else if (line.starts_with(kPlace)) {
      const auto place = read_place(line.substr(kPlace.size()));
      if (place) out.places.push_back(*place);
    } else if (line.starts_with(kBorder)) {
      out.border = read_border(line.substr(kBorder.size()));
    } else if (!line.starts_with('|')) {
      return fail(ErrorCode::bad_value, "the server refused the question for its status");
    }
  }
  return fail(ErrorCode::truncated, "the answer with the status is cut");
}

}  // namespace runstone
