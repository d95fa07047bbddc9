#include "server/world/ground/log_marks.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;

WorldConfig fast_requests() {
  WorldConfig c = config();
  c.view_interval_us = 0;
  return c;
}

struct MarksBench : WorldBench {
  explicit MarksBench(const WorldConfig& c = fast_requests()) : WorldBench(c) {}

  AuthorId join_with(SessionId session, std::uint8_t who,
                     std::uint64_t features = kFeatureLogMarks) {
    return join(session, who, 1, {}, features).author;
  }
  void ask(SessionId session, std::uint32_t request) {
    server.received(session, LogMarksRequest{request, 1, 100, 10}, now());
  }
  /// Answers the oldest read.
  void answer_one(const Result<FoundLogMarks, std::string>& found) {
    const auto [session, request] = environment.mark_requests.front();
    environment.mark_requests.pop_front();
    server.ground().log_marks_read(session, request.request, found, now());
  }
  std::vector<LogMarks> answers(SessionId session) const {
    return environment.messages<LogMarks>(session, kEdge);
  }
};

FoundLogMarks marks_of(AuthorId author) {
  return {3,
          {{5, 1'000, author, Cause::player, EditKind::fill_box},
           {9, 2'000, 0, Cause::console, EditKind::set_voxel}}};
}

}  // namespace

TEST_CASE("a session gets marks of the log with the names of their authors", "[world]") {
  MarksBench bench;
  const AuthorId author = bench.join_with(1, 1);
  bench.ask(1, 4);
  REQUIRE(bench.environment.mark_requests.size() == 1);
  CHECK(bench.environment.mark_requests[0].second == LogMarksRequest{4, 1, 100, 10});
  CHECK(bench.environment.charged[1] == 10 * kLogMarkBytes);
  bench.answer_one(marks_of(author));
  REQUIRE(bench.answers(1).size() == 1);
  const LogMarks answer = bench.answers(1)[0];
  CHECK(answer.request == 4);
  CHECK(answer.first == 3);
  CHECK(answer.marks == marks_of(author).marks);
  CHECK(answer.authors == std::vector<LogAuthor>{{author, "player1"}});
  CHECK(answer.refusal.empty());
}

TEST_CASE("the mark of a voxel is asked for by its place, and counts as more reading", "[world]") {
  MarksBench bench;
  const AuthorId author = bench.join_with(1, 1, kFeatureLogMarks | kFeatureVoxelAuthors);
  const LogMarksRequest request{4, 1, kSequenceMax, 1, VoxelPos{1, -2, 3}};
  bench.server.received(1, request, bench.now());
  REQUIRE(bench.environment.mark_requests.size() == 1);
  CHECK(bench.environment.mark_requests[0].second == request);
  CHECK(bench.environment.charged[1] == kVoxelMarkBytes);
  bench.answer_one(marks_of(author));
  CHECK(bench.answers(1).size() == 1);
}

TEST_CASE("few requests for marks are read at a time, and of each session only the newest",
          "[world]") {
  MarksBench bench;
  for (SessionId session = 1; session <= 4; ++session)
    bench.join_with(session, static_cast<std::uint8_t>(session));
  for (SessionId session = 1; session <= 4; ++session) bench.ask(session, 1);
  CHECK(bench.environment.mark_requests.size() == kLogMarkReadsMax);
  bench.ask(1, 2);
  bench.ask(1, 3);
  // The others have their turns before the session that was first.
  for (SessionId session = 2; session <= 4; ++session) {
    bench.answer_one(FoundLogMarks{});
    REQUIRE(bench.environment.mark_requests.size() == 1);
    CHECK(bench.environment.mark_requests[0].first == session);
  }
  bench.answer_one(FoundLogMarks{});
  REQUIRE(bench.environment.mark_requests.size() == 1);
  CHECK(bench.environment.mark_requests[0].first == 1);
  CHECK(bench.environment.mark_requests[0].second.request == 3);  // 2 was replaced
  bench.ask(2, 2);
  bench.server.disconnected(1);
  bench.answer_one(FoundLogMarks{});
  REQUIRE(bench.environment.mark_requests.size() == 1);  // a session that has ended frees its place
  bench.answer_one(FoundLogMarks{});
  CHECK(bench.answers(2).size() == 2);
  for (SessionId session = 3; session <= 4; ++session) CHECK(bench.answers(session).size() == 1);
}

TEST_CASE("a flood of requests for marks of voxels is limited and delays nobody else", "[world]") {
  WorldConfig c = config();
  c.view_interval_us = 50'000;
  MarksBench bench(c);
  for (SessionId session = 1; session <= 3; ++session)
    bench.join_with(session, static_cast<std::uint8_t>(session),
                    kFeatureLogMarks | kFeatureVoxelAuthors);
  std::uint32_t asked = 0;
  const auto flood = [&](SessionId session) {
    for (int i = 0; i < 200; ++i)
      bench.server.received(
          session, LogMarksRequest{++asked, 1, kSequenceMax, 1, VoxelPos{1, -2, 3}}, bench.now());
  };
  // Two sessions ask without an end for a voxel that costs much. Each read takes 60 ms.
  FoundLogMarks dear;
  dear.cost = 15'000;
  std::map<SessionId, std::size_t> reads;
  for (int round = 0; round < 100; ++round) {
    flood(1);
    flood(2);
    if (round == 50) bench.ask(3, ++asked);
    if (bench.environment.mark_requests.empty()) {
      bench.tick(60'000);
      continue;
    }
    CHECK(bench.environment.mark_requests.size() == 1);
    ++reads[bench.environment.mark_requests[0].first];
    bench.tick(60'000);
    bench.answer_one(dear);
    if (round == 51) CHECK(bench.answers(3).size() == 1);
  }
  // 6 s, and a pause of 0.6 s behind each read.
  for (const SessionId session : {SessionId{1}, SessionId{2}}) {
    CHECK(reads[session] > 5);
    CHECK(reads[session] <= 10);
    CHECK(bench.environment.charged[session] >= reads[session] * kVoxelMarkBytes);
    CHECK(bench.environment.charged[session] <= (reads[session] + 1) * kVoxelMarkBytes);
  }
  CHECK(reads[3] == 1);
}

TEST_CASE("the requests of a session for marks take effect as far apart as its views", "[world]") {
  WorldConfig c = config();
  c.view_interval_us = 200'000;
  MarksBench bench(c);
  bench.join_with(1, 1);
  bench.ask(1, 1);
  bench.answer_one(FoundLogMarks{});
  bench.ask(1, 2);
  CHECK(bench.environment.mark_requests.empty());
  bench.tick(199'999);
  CHECK(bench.environment.mark_requests.empty());
  bench.tick(1);
  CHECK(bench.environment.mark_requests.size() == 1);
}

TEST_CASE("who may not see the past gets no marks", "[world][rights]") {
  MarksBench bench;
  const RightsActor console;
  REQUIRE(bench.server.changes().change_rights(DefineRole{{"guest", {Right::see}, 0, 0, 0}},
                                               console, 0, bench.now()));
  REQUIRE(bench.server.changes().change_rights(SetDefaultRole{"guest"}, console, 0, bench.now()));
  bench.join_with(1, 1);
  bench.ask(1, 1);
  CHECK(bench.environment.mark_requests.empty());
  REQUIRE(bench.answers(1).size() == 1);
  CHECK(bench.answers(1)[0].refusal == "your role does not allow to see the past");
  CHECK(bench.answers(1)[0].marks.empty());
}

TEST_CASE("a log that cannot be read is a refusal, and a full queue loses the answer", "[world]") {
  MarksBench bench;
  bench.join_with(1, 1);
  bench.ask(1, 1);
  bench.answer_one(failure("the log cannot be read now"));
  REQUIRE(bench.answers(1).size() == 1);
  CHECK(bench.answers(1)[0].refusal == "the log cannot be read now");
  bench.ask(1, 2);
  bench.environment.full.insert(1);
  bench.answer_one(FoundLogMarks{});
  bench.environment.full.clear();
  CHECK(bench.answers(1).size() == 1);
  CHECK(bench.environment.closed.empty());
  bench.ask(1, 3);
  bench.answer_one(FoundLogMarks{});
  CHECK(bench.answers(1).size() == 2);
}

TEST_CASE("without the feature a request for marks ends the session", "[world]") {
  MarksBench bench;
  bench.join_with(1, 1, 0);
  bench.ask(1, 1);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::unexpected_message);
}

TEST_CASE("what a rollback would change is sent to the client whose command asked for it",
          "[world]") {
  MarksBench bench;
  bench.join_with(1, 1, kFeatureCommands | kFeatureRestorePreview);
  bench.join_with(2, 2, kFeatureCommands);
  CHECK_FALSE(
      bench.server.people().commands().restore_preview_view(1).has_value());  // it has no view yet
  bench.view(1, {1, {0, 0, 0}, 1, 1});
  bench.view(2, {1, {0, 0, 0}, 1, 1});
  REQUIRE(bench.server.people().commands().restore_preview_view(1).has_value());
  CHECK(bench.server.people().commands().restore_preview_view(1)->radius_h == 1);
  CHECK_FALSE(bench.server.people().commands().restore_preview_view(2).has_value());
  CHECK_FALSE(bench.server.people().commands().restore_preview_view(3).has_value());
  RestorePreview preview;
  preview.preview = "p1";
  preview.voxels = 12;
  preview.edits = {{SetVoxel{{1, 2, 3}}, {}, 1}};
  bench.server.people().commands().show_restore(1, preview);
  CHECK(bench.environment.messages<RestorePreview>(1, kEdge).empty());  // no command is under way
  bench.server.received(1, CommandRequest{7, "rollback preview since 1h"}, bench.now());
  bench.server.received(2, CommandRequest{8, "rollback preview since 1h"}, bench.now());
  bench.server.people().commands().show_restore(1, preview);
  bench.server.people().commands().show_restore(2, preview);
  const auto shown = bench.environment.messages<RestorePreview>(1, kEdge);
  REQUIRE(shown.size() == 1);
  preview.command = 7;
  CHECK(shown[0] == preview);
  CHECK(bench.environment.messages<RestorePreview>(2, kEdge).empty());
}

}  // namespace runstone
