#include "server/replay/camera_path.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>

#include "common/core/coords.hpp"

namespace runstone {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr double kPi = 3.14159265358979323846;
constexpr double kRadiansPerDegree = kPi / 180;

/// Removes the next word from the text and returns it.
std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

template <class T>
std::optional<T> number_of(std::string_view word) {
  T value{};
  const auto [end, wrong] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (wrong != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

std::optional<double> number_in(std::string_view word, double low, double high) {
  const auto value = number_of<double>(word);
  if (!value || !(*value >= low && *value <= high))
    return std::nullopt;  // a NaN is outside the range too
  return value;
}

/// Parses a sequence number, or converts a percentage to a sequence number.
std::optional<double> moment_of(std::string_view word, Sequence first, Sequence last) {
  if (word.ends_with('%')) {
    const auto share = number_in(word.substr(0, word.size() - 1), 0, 100);
    if (!share) return std::nullopt;
    return static_cast<double>(first) + *share / 100 * static_cast<double>(last - first);
  }
  const auto seq = number_of<Sequence>(word);
  if (!seq || *seq > kSequenceMax) return std::nullopt;
  return static_cast<double>(*seq);
}

struct Field {
  const char* name;
  double low, high;
  double DrawCamera::* member;
  double scale;
};
constexpr double kWorld = kWorldLimit;
constexpr std::array<Field, 5> kFields = {
    {{"X", -kWorld, kWorld, &DrawCamera::x, 1},
     {"Y", -kWorld, kWorld, &DrawCamera::y, 1},
     {"Z", -kWorld, kWorld, &DrawCamera::z, 1},
     {"YAW", -360, 360, &DrawCamera::yaw, kRadiansPerDegree},
     {"PITCH", -90, 90, &DrawCamera::pitch, kRadiansPerDegree}}};

}  // namespace

Result<CameraPath, TextError> CameraPath::parse(std::string_view text, std::string_view file,
                                                Sequence first, Sequence last) {
  CameraPath path;
  std::uint32_t line_number = 0;
  const auto wrong = [&](std::string what) {
    return failure(TextError{std::string(file), line_number, "", std::move(what)});
  };
  while (!text.empty()) {
    ++line_number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    line = line.substr(0, line.find('#'));
    const std::string_view when = take_word(line);
    if (when.empty()) continue;
    Station station;
    const auto moment = moment_of(when, first, last);
    if (!moment) return wrong("the moment is no sequence number and no share from 0% to 100%");
    station.when = *moment;
    for (const Field& field : kFields) {
      const std::string_view word = take_word(line);
      if (word.empty())
        return wrong(std::string(field.name) + " is missing: expected WHEN X Y Z YAW PITCH");
      const auto value = number_in(word, field.low, field.high);
      if (!value) {
        return wrong(std::string(field.name) + " is no number from " +
                     std::to_string(static_cast<long>(field.low)) + " to " +
                     std::to_string(static_cast<long>(field.high)));
      }
      station.camera.*field.member = *value * field.scale;
    }
    if (!take_word(line).empty()) return wrong("more than WHEN X Y Z YAW PITCH");
    if (!path.stations_.empty() && station.when <= path.stations_.back().when) {
      return wrong("the moment is not after that of the station before");
    }
    if (path.stations_.size() == kStationsMax) return wrong("more than 10000 stations");
    path.stations_.push_back(station);
  }
  line_number = 0;
  if (path.stations_.empty()) return wrong("has no station");
  return path;
}

DrawCamera CameraPath::at(Sequence seq) const {
  const auto moment = static_cast<double>(seq);
  const auto next = std::lower_bound(stations_.begin(), stations_.end(), moment,
                                     [](const Station& s, double when) { return s.when < when; });
  if (next == stations_.begin()) return next->camera;
  const Station& before = *std::prev(next);
  if (next == stations_.end()) return before.camera;
  const double share = (moment - before.when) / (next->when - before.when);
  const auto mix = [share](double a, double b) { return a + (b - a) * share; };
  DrawCamera camera = before.camera;
  camera.x = mix(before.camera.x, next->camera.x);
  camera.y = mix(before.camera.y, next->camera.y);
  camera.z = mix(before.camera.z, next->camera.z);
  const double turn = std::remainder(next->camera.yaw - before.camera.yaw, 2 * kPi);
  camera.yaw = before.camera.yaw + turn * share;
  camera.pitch = mix(before.camera.pitch, next->camera.pitch);
  return camera;
}

}  // namespace runstone
