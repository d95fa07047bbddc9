#include "client/display/pose_track.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace runstone;

namespace {

constexpr TimeUs kMs = 1'000;

Pose at_x(double x, std::uint16_t yaw = 0) { return {{x, 0, 0}, yaw, 0}; }

/// A player who walks along x at 5 voxels a second. A pose arrives every 100 ms, from 0 on.
PoseTrack walking(int poses) {
  PoseTrack track(at_x(0), 0);
  for (int i = 1; i < poses; ++i) track.add(at_x(0.5 * i), i * 100 * kMs);
  return track;
}

}  // namespace

TEST_CASE("a player is at the first pose at once and stays there", "[client_display]") {
  const PoseTrack track(at_x(7), 5 * kMs);
  CHECK(track.at(5 * kMs) == at_x(7));
  CHECK(track.at(5'000 * kMs) == at_x(7));
  CHECK_FALSE(track.is_moving(5 * kMs));
}

TEST_CASE("between two poses a player moves evenly", "[client_display]") {
  PoseTrack track = walking(20);
  const TimeUs end = 1'900 * kMs;
  double before = track.at(end).at.x;
  for (TimeUs now = end + 10 * kMs; now < end + 90 * kMs; now += 10 * kMs) {
    const double x = track.at(now).at.x;
    CHECK(x - before == Approx(0.05).margin(0.007));  // 5 voxels a second, within kDelayRate
    before = x;
  }
  CHECK(track.is_moving(end));
}

TEST_CASE("the delay is a little more than the time between poses", "[client_display]") {
  CHECK(walking(200).delay_us(19'900 * kMs) >= 95 * kMs);
  CHECK(walking(200).delay_us(19'900 * kMs) <= 115 * kMs);
}

TEST_CASE("the delay follows another interval gradually, and time never runs back",
          "[client_display]") {
  PoseTrack track = walking(100);
  TimeUs sent = 9'900 * kMs;
  double x = track.latest().at.x, shown = track.at(sent).at.x;
  const TimeUs delay_before = track.delay_us(sent);
  for (int i = 0; i < 300; ++i) {
    for (TimeUs now = sent; now < sent + 250 * kMs; now += 10 * kMs) {
      const double next = track.at(now).at.x;
      REQUIRE(next >= shown - 0.3);  // a late pose may correct what was extrapolated
      shown = next;
    }
    sent += 250 * kMs;
    x += 1.25;
    track.add(at_x(x), sent);
    if (i == 0) CHECK(track.delay_us(sent) - delay_before <= 250 * kMs / 8);
  }
  CHECK(track.delay_us(sent) >= 245 * kMs);
  CHECK(track.delay_us(sent) <= 300 * kMs);
}

TEST_CASE("poses that arrive irregularly are shown without standing still", "[client_display]") {
  std::mt19937 random(1);
  PoseTrack track(at_x(0), 0);
  TimeUs sent = 0, arrived = 0, drawn = 0;
  double shown = 0;
  int still = 0, frames = 0;
  for (int i = 1; i < 400; ++i) {
    sent += 100 * kMs;
    arrived = std::max(arrived + 1, sent + static_cast<TimeUs>(random() % 40'000));
    for (; drawn < arrived; drawn += 16 * kMs) {
      const double x = track.at(drawn).at.x;
      if (i > 50) {
        ++frames;
        if (x - shown < 0.01) ++still;  // 0.08 at even speed
      }
      shown = x;
    }
    track.add(at_x(static_cast<double>(sent) * 5e-6), arrived);
  }
  CHECK(frames > 2'000);
  CHECK(still * 50 < frames);
}

TEST_CASE("a player who stops is shown at the last pose, and then nothing moves",
          "[client_display]") {
  const PoseTrack track = walking(20);
  const TimeUs end = 1'900 * kMs;
  double farthest = 0;
  TimeUs moves_until = end;
  for (TimeUs now = end; now < end + 1'000 * kMs; now += kMs) {
    farthest = std::max(farthest, track.at(now).at.x);
    if (track.is_moving(now)) moves_until = now;
  }
  CHECK(farthest > 9.5);
  CHECK(farthest < 9.5 + 0.1);  // what was extrapolated
  CHECK(track.at(end + 1'000 * kMs) == at_x(9.5));
  CHECK(moves_until < end + PoseTrack::kDelayUsMax + PoseTrack::kExtrapolateUs);
}

TEST_CASE("a player who begins to move after a pause does not jump", "[client_display]") {
  PoseTrack track = walking(20);
  const TimeUs begins = 60'000 * kMs;
  CHECK(track.at(begins) == at_x(9.5));
  track.add(at_x(10), begins);
  CHECK(track.at(begins).at.x == Approx(9.5));
  CHECK(track.at(begins + 60 * kMs).at.x > 9.6);
  CHECK(track.at(begins + 60 * kMs).at.x < 10);
}

TEST_CASE("a pause does not count as an interval", "[client_display]") {
  PoseTrack track = walking(100);
  const TimeUs delay = track.delay_us(9'900 * kMs);
  track.add(at_x(60), 60'000 * kMs);
  CHECK(track.delay_us(60'000 * kMs) <= delay);
}

TEST_CASE("a player who is teleported is there at once", "[client_display]") {
  PoseTrack track = walking(20);
  track.add(at_x(500), 2'000 * kMs);
  CHECK(track.at(2'000 * kMs) == at_x(500));
  CHECK_FALSE(track.is_moving(2'000 * kMs));
  track.add(at_x(500.5), 2'100 * kMs);
  CHECK(track.at(2'100 * kMs).at.x >= 500);
}

TEST_CASE("angles turn the shorter way", "[client_display]") {
  const Pose a = at_x(0, 65'000), b = at_x(0, 464);  // 1,000 apart across the zero
  CHECK(between(a, b, 0.25).yaw == 65'250);
  CHECK(between(a, b, 0.5).yaw == 65'500);
  CHECK(between(a, b, 0.75).yaw == 214);
  CHECK(between(b, a, 0.5).yaw == 65'500);
  Pose up = at_x(0), down = at_x(0);
  up.pitch = 16'000;
  down.pitch = -16'000;
  CHECK(between(up, down, 0.5).pitch == 0);
  CHECK(between(down, up, 3).pitch == 32'767);  // extrapolated: as far as it goes
}

TEST_CASE("several poses in one moment count as the last one", "[client_display]") {
  PoseTrack track(at_x(0), 0);
  track.add(at_x(1), 100 * kMs);
  track.add(at_x(2), 100 * kMs);
  CHECK(track.latest() == at_x(2));
  CHECK(track.at(1'000 * kMs) == at_x(2));
}

TEST_CASE("more poses than are kept are no harm", "[client_display]") {
  PoseTrack track(at_x(0), 0);
  for (int i = 1; i <= 1'000; ++i) track.add(at_x(i * 0.01), i * kMs);
  CHECK(track.at(1'000 * kMs).at.x <= 10);
  CHECK(track.at(3'000 * kMs) == at_x(10));
}
