#include "server/net/chunk_pace.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <deque>
#include <queue>
#include <string>
#include <vector>

#include "client/stream/receive_ack_scheduler.hpp"
#include "common/core/hash.hpp"

namespace runstone {
namespace {

struct Profile {
  const char* name;
  TimeUs round_trip_us, jitter_us;
  std::uint64_t bytes_per_second;
};
constexpr Profile kProfiles[] = {{"lan", 400, 0, 125'000'000},
                                 {"broadband", 40'000, 0, 6'250'000},
                                 {"mobile", 120'000, 20'000, 625'000}};

/// One direction of a link: an unbounded queue, a transmitter, then a delay that never reorders.
struct Way {
  const Profile& profile;
  SplitMix64& random;
  double free_us = 0, last_due_us = 0;
  /// Returns when the last bit arrives.
  TimeUs push(std::size_t bytes, TimeUs now_us) {
    const double rate = static_cast<double>(profile.bytes_per_second) / 1e6;
    free_us = std::max(free_us, static_cast<double>(now_us)) + static_cast<double>(bytes) / rate;
    const double swing = random.below(1'000'001) / 500'000.0 - 1;
    const double due = free_us + static_cast<double>(profile.round_trip_us) / 2 +
                       swing * static_cast<double>(profile.jitter_us);
    last_due_us = std::max(last_due_us, due);
    return static_cast<TimeUs>(last_due_us);
  }
};

struct Outcome {
  double used = 0;                // share of the link
  TimeUs p50_us = 0, p99_us = 0;  // of edits, there and back
  std::uint64_t in_flight_max = 0;
};

/// A server with unlimited terrain and some edits, and a client that reads at once, in virtual
/// time.
struct Run {
  explicit Run(const Profile& p, std::uint64_t seed) : profile(p), random(seed) {}

  struct Event {
    TimeUs at_us;
    std::uint64_t order;
    enum class Kind { arrives, told, report, edit, wake, tcp_ack } kind;
    std::uint64_t value;
    bool operator>(const Event& o) const {
      return at_us != o.at_us ? at_us > o.at_us : order > o.order;
    }
  };

  const Profile& profile;
  SplitMix64 random;
  Way down{profile, random}, up{profile, random};
  ChunkPace pace;
  ReceiveAckScheduler report;
  bool is_acknowledging = true, has_terrain = true;
  TimeUs now_us = 0;
  std::uint64_t order = 0, read = 0;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events;
  std::vector<TimeUs> edits_us;
  std::uint64_t in_flight_max = 0;
  TimeUs wakes_us = 0;
  // The window of TCP in its slow start: bytes beyond it wait. 0: TCP does not limit.
  std::size_t tcp_window = 0, tcp_in_flight = 0;
  std::deque<std::size_t> tcp_waiting;

  void at(TimeUs at_us, Event::Kind kind, std::uint64_t value = 0) {
    events.push({at_us, order++, kind, value});
  }

  /// Sends a fragment as packets of the link.
  void send_one() {
    constexpr std::size_t kPacket = 1'448;
    const std::size_t bytes = pace.fragment_bytes() + kFrameHeaderBytes;
    for (std::size_t left = bytes; left > 0;) {
      const std::size_t packet = std::min(left, kPacket);
      tcp_waiting.push_back(packet);
      left -= packet;
    }
    let_tcp_send();
    pace.sent(bytes, now_us);
    in_flight_max = std::max(in_flight_max, pace.in_flight());
  }
  void let_tcp_send() {
    while (!tcp_waiting.empty() &&
           (tcp_window == 0 || tcp_in_flight + tcp_waiting.front() <= tcp_window)) {
      const std::size_t packet = tcp_waiting.front();
      tcp_waiting.pop_front();
      tcp_in_flight += packet;
      at(down.push(packet + 52, now_us), Event::Kind::arrives, packet);
    }
  }
  /// The writer of a session: sends fragments while it may.
  void write() {
    while (has_terrain) {
      if (!pace.may_send(now_us)) {
        const TimeUs next_us = pace.next_us(now_us);
        if (wakes_us <= now_us || next_us < wakes_us)
          at(wakes_us = std::max(next_us, now_us + 60), Event::Kind::wake);
        return;
      }
      send_one();
    }
  }
  void acknowledge() {
    if (!is_acknowledging || !report.is_due(read, now_us)) return;
    report.sent(read, now_us);
    at(up.push(100, now_us), Event::Kind::told, read);
  }
  void edit() {
    // Half a round trip to the server without terrain, then back behind the bytes in flight.
    const TimeUs there_us = profile.round_trip_us / 2 +
                            random.between(0, static_cast<std::int32_t>(2 * profile.jitter_us)) -
                            profile.jitter_us;
    edits_us.push_back(there_us + down.push(250, now_us) - now_us);
    at(now_us + random.between(5'000, 45'000), Event::Kind::edit);
  }
  /// Runs until this time.
  Outcome run(TimeUs until_us) {
    if (now_us == 0) at(0, Event::Kind::edit);
    write();
    while (!events.empty() && events.top().at_us < until_us) {
      const Event e = events.top();
      events.pop();
      now_us = e.at_us;
      switch (e.kind) {
        case Event::Kind::arrives:
          read += e.value;
          at(now_us + profile.round_trip_us / 2, Event::Kind::tcp_ack, e.value);
          acknowledge();
          if (const auto due = report.due(read)) at(std::max(*due, now_us), Event::Kind::report);
          break;
        case Event::Kind::report:
          acknowledge();
          break;
        case Event::Kind::told:
          REQUIRE(pace.acked(e.value, now_us).has_value());
          write();
          break;
        case Event::Kind::edit:
          edit();
          break;
        case Event::Kind::wake:
          write();
          break;
        case Event::Kind::tcp_ack:
          tcp_in_flight -= e.value;
          if (tcp_window != 0) tcp_window += e.value;
          let_tcp_send();
          break;
      }
    }
    now_us = until_us;
    Outcome out;
    const double could =
        static_cast<double>(profile.bytes_per_second) * static_cast<double>(until_us) / 1e6;
    out.used = static_cast<double>(read) * 1'500 / 1'448 / could;
    std::sort(edits_us.begin(), edits_us.end());
    out.p50_us = edits_us[edits_us.size() / 2];
    out.p99_us = edits_us[edits_us.size() * 99 / 100];
    out.in_flight_max = in_flight_max;
    return out;
  }
};

TEST_CASE("an edit waits only shortly behind terrain, and terrain still uses the link",
          "[net][pace]") {
  for (const Profile& profile : kProfiles) {
    const unsigned seeds = profile.jitter_us > 0 ? 12 : 2;
    for (unsigned seed = 1; seed <= seeds; ++seed) {
      Run run(profile, seed);
      const Outcome out = run.run(30'000'000);
      const auto fragment_us =
          static_cast<TimeUs>(kFragmentBytesMax * 1'000'000 / profile.bytes_per_second);
      const TimeUs allowed_us =
          profile.round_trip_us + 2 * profile.jitter_us + 2 * fragment_us + 10'000;
      CAPTURE(profile.name, seed, out.used, out.p50_us, out.p99_us, allowed_us);
      CHECK(out.used >= 0.85);
      CHECK(out.p99_us <= allowed_us);
    }
  }
}

TEST_CASE("a new session uses its whole link despite varying delay and TCP's slow start",
          "[net][pace]") {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Run run(kProfiles[2], seed);
    run.tcp_window = 10 * 1'448;
    const Outcome out = run.run(3'000'000);
    CAPTURE(seed, out.used, run.pace.rate());
    CHECK(out.used >= 0.60);
  }
}

TEST_CASE("the pace follows a link that becomes slower or faster", "[net][pace]") {
  Profile profile{"changing", 40'000, 0, 6'250'000};
  Run run(profile, 3);
  run.run(5'000'000);
  profile.bytes_per_second = 625'000;
  run.run(10'000'000);
  run.edits_us.clear();
  const Outcome slower = run.run(15'000'000);
  const auto fragment_us =
      static_cast<TimeUs>(kFragmentBytesMax * 1'000'000 / profile.bytes_per_second);
  CHECK(slower.p99_us <= profile.round_trip_us + 2 * fragment_us + 10'000);
  profile.bytes_per_second = 6'250'000;
  run.run(25'000'000);
  const std::uint64_t before = run.read;
  run.run(30'000'000);
  CHECK(run.read - before >= 5 * profile.bytes_per_second * 85 / 100);
}

TEST_CASE("a client without acknowledgements gets the start, then a fragment a second",
          "[net][pace]") {
  const Profile profile{"silent", 40'000, 0, 6'250'000};
  Run run(profile, 4);
  run.is_acknowledging = false;
  run.run(900'000);
  CHECK(run.pace.in_flight() <= ChunkPace::kStartBytes);
  const std::uint64_t start = run.pace.in_flight();
  run.run(10'900'000);
  CHECK(run.pace.in_flight() > start);  // it continues slowly
  CHECK(run.pace.in_flight() - start <= 10 * (kFragmentBytesMax + kFrameHeaderBytes));
}

TEST_CASE("a client that stops to acknowledge is limited to the bytes in flight", "[net][pace]") {
  const Profile profile{"stopped", 40'000, 0, 6'250'000};
  Run run(profile, 5);
  run.run(5'000'000);
  run.is_acknowledging = false;
  run.run(6'000'000);
  const std::uint64_t held = run.pace.in_flight();
  CHECK(held <= run.pace.window());
  run.run(16'000'000);
  CHECK(run.pace.in_flight() - held <= 11 * (kFragmentBytesMax + kFrameHeaderBytes));
}

TEST_CASE("acknowledgements of bytes that were not sent, or of fewer than before, are errors",
          "[net][pace]") {
  ChunkPace pace;
  CHECK_FALSE(pace.acked(1, 0).has_value());
  pace.sent(1'000, 10);
  CHECK_FALSE(pace.acked(1'001, 20).has_value());
  CHECK(pace.acked(600, 30).has_value());
  CHECK(pace.acked(600, 40).has_value());
  CHECK_FALSE(pace.acked(599, 50).has_value());
  CHECK(pace.in_flight() == 400);
}

TEST_CASE("an acknowledgement of all bytes at once overflows no number", "[net][pace]") {
  ChunkPace pace;
  std::uint64_t total = 0;
  for (TimeUs now_us = 0; now_us < 2'000'000; now_us += 7) {
    if (!pace.may_send(now_us)) continue;
    const std::size_t bytes = pace.fragment_bytes();
    pace.sent(bytes + kFrameHeaderBytes, now_us);
    total += bytes + kFrameHeaderBytes;
    REQUIRE(pace.acked(total, now_us).has_value());
  }
  CHECK(pace.window() <= (256ULL << 20));
  CHECK(pace.in_flight() == 0);
}

TEST_CASE("bytes sent while there was little to send do not lower the rate", "[net][pace]") {
  const Profile profile{"pauses", 40'000, 0, 6'250'000};
  Run run(profile, 6);
  run.run(5'000'000);
  const std::uint64_t rate = run.pace.rate();
  run.has_terrain = false;
  for (int i = 0; i < 100; ++i) {  // a fragment from time to time
    run.run(run.now_us + 50'000);
    run.pace.mark_app_limited();
    run.send_one();
    run.pace.mark_app_limited();
  }
  CHECK(run.pace.rate() >= rate * 9 / 10);
}

}  // namespace
}  // namespace runstone
