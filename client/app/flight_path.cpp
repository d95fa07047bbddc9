#include "client/app/flight_path.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <sstream>
#include <string>

namespace runstone {
namespace {

constexpr std::uint32_t kFramesMax = 100'000;

}  // namespace

FlightPath::Place FlightPath::place(std::uint32_t frame) const {
  const auto next = std::find_if(stops_.begin() + 1, stops_.end() - 1,
                                 [frame](const Stop& stop) { return frame < stop.frame; });
  const Stop& from = *std::prev(next);
  const double share = next->frame == from.frame
                           ? 1
                           : std::min(1.0, static_cast<double>(frame - from.frame) /
                                               static_cast<double>(next->frame - from.frame));
  const auto between = [share](double a, double b) { return a + (b - a) * share; };
  const Place &a = from.place, &b = next->place;
  return {{between(a.at.x, b.at.x), between(a.at.y, b.at.y), between(a.at.z, b.at.z)},
          between(a.yaw, b.yaw),
          between(a.pitch, b.pitch)};
}

Result<FlightPath, TextError> FlightPath::parse(std::string_view text, std::string_view file) {
  constexpr double kRadians = std::numbers::pi / 180;
  FlightPath out;
  std::istringstream lines{std::string(text)};
  std::uint32_t number = 0;
  const auto fail = [&](std::uint32_t line, const char* what) {
    return failure(TextError{std::string(file), line, {}, what});
  };
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line.resize(std::min(line.size(), line.find('#')));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::istringstream words(line);
    std::array<double, 6> v{};
    for (double& value : v) words >> value;
    std::string rest;
    if (!words || words >> rest) return fail(number, "expected X Y Z YAW PITCH FRAMES");
    if (!(v[5] >= 0 && v[5] <= kFramesMax)) return fail(number, "FRAMES is 0 to 100000");
    if (!out.stops_.empty()) out.frames_ += static_cast<std::uint32_t>(v[5]);
    if (out.frames_ > kFramesMax) return fail(number, "more than 100000 frames");
    out.stops_.push_back({{{v[0], v[1], v[2]}, v[3] * kRadians, v[4] * kRadians}, out.frames_});
  }
  if (out.stops_.size() < 2 || out.frames_ == 0)
    return fail(number, "a path has two places or more, and a frame between them");
  return out;
}

}  // namespace runstone
