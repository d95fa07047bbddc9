#include "client/session/log_timeline.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/client/session/session_bench.hpp"

using namespace runstone;

namespace {

constexpr TimeUs kSecond = 1'000'000;

LogMarks answer_to(const LogMarksRequest& request) {
  LogMarks out;
  out.request = request.request;
  for (Sequence seq = request.first; seq <= request.last && out.marks.size() < request.count;
       seq += std::max<Sequence>(1, (request.last - request.first) / request.count))
    out.marks.push_back({seq, static_cast<TimeUs>(seq), 7, Cause::player, EditKind::set_voxel});
  out.authors = {{7, "ann"}};
  return out;
}

/// A timeline, and a server that answers at once.
struct TimelineBench {
  /// Lets the timeline ask once. Returns the request.
  std::optional<LogMarksRequest> turn(Sequence newest, Sequence shown) {
    const auto request = timeline.next_request(newest, shown, now);
    if (request) CHECK(timeline.receive(answer_to(*request), now));
    return request;
  }
  LogTimeline timeline;
  TimeUs now = 100 * kSecond;
};

}  // namespace

TEST_CASE("a timeline asks for marks of all the log, and for the edits before the shown moment",
          "[client_session]") {
  TimelineBench bench;
  CHECK(bench.turn(1'000, 1'000) == LogMarksRequest{1, 1, 1'000, LogTimeline::kBandMarks});
  CHECK(bench.turn(1'000, 1'000) == LogMarksRequest{2, 991, 1'000, 10});
  CHECK(bench.timeline.band().size() == LogTimeline::kBandMarks);
  CHECK(bench.timeline.recent().size() == 10);
  CHECK(bench.timeline.recent().back().seq == 1'000);
  CHECK(bench.timeline.name_of(7) == "ann");
  CHECK(bench.timeline.name_of(8) == "#8");
  CHECK(bench.timeline.name_of(0) == "the server");
  bench.now += 60 * kSecond;
  CHECK_FALSE(bench.turn(1'000, 1'000).has_value());  // nothing is new
}

TEST_CASE("another moment brings its edits, and a world in use the new ones", "[client_session]") {
  TimelineBench bench;
  bench.turn(1'000, 1'000);
  bench.turn(1'000, 1'000);
  bench.now += kSecond;
  CHECK(bench.turn(1'000, 5) == LogMarksRequest{3, 1, 5, 5});
  CHECK_FALSE(bench.turn(1'000, 6).has_value());  // too soon
  bench.now += kSecond;
  CHECK(bench.turn(1'000, 6)->last == 6);
  bench.now += kSecond;
  CHECK_FALSE(bench.turn(1'000, 0).has_value());  // before the first edit there is none
  CHECK(bench.timeline.recent().empty());
  bench.now += 10 * kSecond;
  CHECK_FALSE(bench.turn(1'010, 0).has_value());  // the log has hardly grown
  CHECK(bench.turn(1'020, 0)->count == LogTimeline::kBandMarks);
}

TEST_CASE("one request of a timeline is under way at a time, and lost answers are asked again",
          "[client_session]") {
  LogTimeline timeline;
  TimeUs now = 5 * kSecond;
  const auto first = timeline.next_request(10, 10, now);
  REQUIRE(first.has_value());
  CHECK_FALSE(timeline.next_request(10, 10, now + kSecond).has_value());
  CHECK_FALSE(timeline.receive(answer_to({first->request + 1, 1, 10, 10}), now));
  CHECK(timeline.band().empty());
  now += LogTimeline::kAnswerUsMax;
  CHECK(timeline.next_request(10, 10, now).has_value());
}

TEST_CASE("a refused timeline says why and asks seldom", "[client_session]") {
  LogTimeline timeline;
  const auto request = timeline.next_request(10, 10, kSecond);
  LogMarks refused;
  refused.request = request->request;
  refused.refusal = "your role does not allow to see the past";
  CHECK(timeline.receive(refused, kSecond));
  CHECK(timeline.refusal() == refused.refusal);
  CHECK_FALSE(timeline.next_request(10, 10, 2 * kSecond).has_value());
  const auto again = timeline.next_request(10, 10, kSecond + LogTimeline::kRefusedUs);
  REQUIRE(again.has_value());
  timeline.receive(answer_to(*again), 12 * kSecond);
  CHECK(timeline.refusal().empty());
}

TEST_CASE("a timeline of an empty log asks for nothing", "[client_session]") {
  LogTimeline timeline;
  CHECK_FALSE(timeline.next_request(0, 0, kSecond).has_value());
}

TEST_CASE("after a lost connection the timeline keeps its marks and asks again",
          "[client_session]") {
  TimelineBench bench;
  bench.turn(100, 100);
  bench.timeline.disconnected();
  CHECK_FALSE(bench.timeline.band().empty());
  bench.now += 10 * kSecond;
  CHECK(bench.turn(100, 100)->request == 1);
}

namespace runstone::test::session_bench {

TEST_CASE("a session shows the changes of a rollback whose preview its command asked for",
          "[client_session]") {
  SessionBench bench;
  bench.greet();
  Welcome welcome = bench.server.make_welcome();
  welcome.features = kFeatureCommands | kFeatureRestorePreview;
  welcome.signature = sign(bench.server.keys_of_server,
                           server_transcript(bench.server.hello, welcome, std::nullopt));
  bench.receive(welcome);
  bench.receive(SessionAccepted{6, 0});
  static_cast<void>(bench.sent());
  bench.receive(RestorePreview{});  // nobody asked
  CHECK_FALSE(bench.session.restore_preview().has_value());
  REQUIRE(bench.session.command("rollback preview since 1h").has_value());
  const auto requests = take<CommandRequest>(bench.sent());
  REQUIRE(requests.size() == 1);
  RestorePreview preview;
  preview.command = requests[0].id;
  preview.preview = "p1";
  preview.edits = {{SetVoxel{{1, 2, 3}}, {}, 1}, {SetVoxel{{1, 2, 4}}, {}, 60'000}};
  bench.receive(preview);
  REQUIRE(bench.session.restore_preview().has_value());
  CHECK(bench.session.restore_preview()->edits.size() == 1);  // the other material is unknown
  CHECK(bench.session.is_open());
  bench.receive(CommandOutput{requests[0].id, {"preview p1"}, true, true});
  CHECK(bench.session.restore_preview()->preview == "p1");
  REQUIRE(bench.session.command("players").has_value());
  CHECK_FALSE(bench.session.restore_preview().has_value());
}

}  // namespace runstone::test::session_bench
