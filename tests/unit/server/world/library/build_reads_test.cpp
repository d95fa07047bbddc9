#include "server/world/library/build_reads.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;

constexpr std::uint64_t kReadFileBytes = kBuildPieceBytes * 2 + 100;

/// A world whose library has the build 1, added by the console.
struct BuildReadsBench : WorldBench {
  explicit BuildReadsBench(TimeUs view_interval_us = 0)
      : WorldBench(config_with(view_interval_us)) {
    AddBuild build;
    build.info.name = "Mill";
    build.file_bytes = kReadFileBytes;
    const auto added = server.changes().add_build(build, 0, now());
    REQUIRE(added.has_value());
    REQUIRE(*added == 1);
  }
  static WorldConfig config_with(TimeUs view_interval_us) {
    WorldConfig c = config();
    c.view_interval_us = view_interval_us;
    return c;
  }
  AuthorId join_with(SessionId session) {
    return join(session, static_cast<std::uint8_t>(session), 1, {}, kFeatureBuilds).author;
  }
  void list(SessionId session, std::uint32_t request) {
    BuildsRequest asked;
    asked.request = request;
    asked.name = "mi";
    asked.count = 10;
    server.received(session, asked, now());
  }
  void piece(SessionId session, std::uint32_t request, std::uint64_t offset = 0,
             Sequence number = 1) {
    server.received(session, BuildPieceRequest{request, number, offset}, now());
  }
  void answer_list(Result<FoundBuilds, std::string> found) {
    const auto [session, request] = environment.list_requests.front();
    environment.list_requests.pop_front();
    server.build_reads().found(session, request.request, std::move(found), now());
  }
  void answer_piece(Result<Bytes, std::string> bytes) {
    const auto [session, request] = environment.piece_requests.front();
    environment.piece_requests.pop_front();
    server.build_reads().piece_read(session, request.request, std::move(bytes), now());
  }
  std::vector<Builds> lists(SessionId session) const {
    return environment.messages<Builds>(session, kEdge);
  }
  std::vector<BuildPiece> pieces(SessionId session) const {
    return environment.messages<BuildPiece>(session, kEdge);
  }
};

FoundBuilds build_of(AuthorId author) {
  ListedBuild build;
  build.info.name = "Mill";
  build.file_bytes = kReadFileBytes;
  build.added_by = author;
  return {{build}, true};
}

}  // namespace

TEST_CASE("a session gets a page of the library with the names of those who added builds",
          "[world][library]") {
  BuildReadsBench bench;
  const AuthorId author = bench.join_with(1);
  bench.list(1, 4);
  REQUIRE(bench.environment.list_requests.size() == 1);
  CHECK(bench.environment.list_requests[0].second.name == "mi");
  CHECK(bench.environment.charged[1] == 10 * kListedBuildBytes);
  bench.answer_list(build_of(author));
  REQUIRE(bench.lists(1).size() == 1);
  const Builds answer = bench.lists(1)[0];
  CHECK(answer.request == 4);
  CHECK(answer.has_more);
  CHECK(answer.total == 1);
  CHECK(answer.refusal.empty());
  REQUIRE(answer.builds.size() == 1);
  CHECK(answer.builds[0].added_by == author);
  CHECK(answer.builds[0].added_by_name == "player1");
  bench.list(1, 5);
  bench.answer_list(failure("the library cannot be read now"));
  REQUIRE(bench.lists(1).size() == 2);
  CHECK(bench.lists(1)[1].refusal == "the library cannot be read now");
}

TEST_CASE("few lists are read at a time, and of a session only the newest that waits",
          "[world][library]") {
  BuildReadsBench bench;
  for (SessionId session = 1; session <= 4; ++session) bench.join_with(session);
  for (SessionId session = 1; session <= 4; ++session) bench.list(session, 1);
  CHECK(bench.environment.list_requests.size() == kBuildListsRead);
  bench.list(1, 2);
  bench.list(1, 3);
  bench.server.disconnected(4);
  std::vector<std::pair<SessionId, std::uint32_t>> read;
  while (!bench.environment.list_requests.empty()) {
    const auto& [session, request] = bench.environment.list_requests.front();
    read.emplace_back(session, request.request);
    bench.answer_list(FoundBuilds{});
  }
  CHECK(read == std::vector<std::pair<SessionId, std::uint32_t>>{{1, 1}, {2, 1}, {3, 1}, {1, 3}});
  CHECK(bench.lists(1).size() == 2);
}

TEST_CASE("the lists of a session begin as far apart as its views", "[world][library]") {
  BuildReadsBench bench(200'000);
  bench.join_with(1);
  bench.list(1, 1);
  bench.answer_list(FoundBuilds{});
  bench.list(1, 2);
  bench.tick(199'999);
  CHECK(bench.environment.list_requests.empty());
  bench.tick(1);
  CHECK(bench.environment.list_requests.size() == 1);
}

TEST_CASE("pieces come in the order of the requests, one at a time for each session",
          "[world][library]") {
  BuildReadsBench bench;
  bench.join_with(1);
  bench.piece(1, 1, 0);
  bench.piece(1, 2, kBuildPieceBytes * 2);
  bench.piece(1, 3, kBuildPieceBytes * 3);  // behind the end
  bench.piece(1, 4, 0, 9);                  // no such build
  bench.piece(1, 5);                        // too many
  REQUIRE(bench.pieces(1).size() == 1);
  CHECK(bench.pieces(1)[0].request == 5);
  CHECK(bench.pieces(1)[0].refusal ==
        "at most 4 pieces may be under way: wait for an answer before the next request");
  REQUIRE(bench.environment.piece_requests.size() == 1);
  CHECK(bench.environment.charged[1] == kBuildPieceBytes);
  bench.answer_piece(Bytes(kBuildPieceBytes, 1));
  REQUIRE(bench.environment.piece_requests.size() == 1);
  CHECK(bench.environment.charged[1] == kBuildPieceBytes + 100);
  bench.answer_piece(Bytes(100, 2));
  const auto pieces = bench.pieces(1);
  REQUIRE(pieces.size() == 5);
  CHECK(pieces[1] == BuildPiece{1, Bytes(kBuildPieceBytes, 1), ""});
  CHECK(pieces[2] == BuildPiece{2, Bytes(100, 2), ""});
  CHECK(pieces[3] == BuildPiece{3, {}, "the file of build 1 ends at byte 131172"});
  CHECK(pieces[4] == BuildPiece{4, {}, "the library has no build 9"});
  bench.piece(1, 6);
  bench.answer_piece(failure("the library cannot be read now"));
  CHECK(bench.pieces(1).back().refusal == "the library cannot be read now");
}

TEST_CASE("sessions take turns when their pieces are read, and one that ends loses its turn",
          "[world][library]") {
  BuildReadsBench bench;
  for (SessionId session = 1; session <= 6; ++session) bench.join_with(session);
  for (SessionId session = 1; session <= 6; ++session) {
    bench.piece(session, 1);
    bench.piece(session, 2);
  }
  CHECK(bench.environment.piece_requests.size() == kBuildPiecesRead);
  bench.server.disconnected(2);
  std::vector<SessionId> read;
  while (!bench.environment.piece_requests.empty()) {
    read.push_back(bench.environment.piece_requests.front().first);
    bench.answer_piece(Bytes(1, 1));
  }
  CHECK(read == std::vector<SessionId>{1, 2, 3, 4, 5, 6, 1, 3, 4, 5, 6});
  CHECK(bench.pieces(1).size() == 2);
  CHECK(bench.pieces(2).empty());
}

TEST_CASE("an answer that found the queue full is sent later, and nothing is read meanwhile",
          "[world][library]") {
  BuildReadsBench bench;
  bench.join_with(1);
  bench.piece(1, 1);
  bench.piece(1, 2);
  bench.environment.full.insert(1);
  bench.answer_piece(Bytes(1, 1));
  bench.tick();
  CHECK(bench.pieces(1).empty());
  bench.environment.piece_requests.clear();  // of request 2, if it is read
  bench.environment.full.clear();
  bench.tick();
  REQUIRE(bench.pieces(1).size() == 1);
  CHECK(bench.pieces(1)[0].request == 1);
  REQUIRE(bench.environment.piece_requests.size() == 1);
  CHECK(bench.environment.piece_requests[0].second.request == 2);
  CHECK(bench.environment.closed.empty());
}

TEST_CASE("who may not see the world any more gets nothing of its library", "[world][library]") {
  BuildReadsBench bench;
  bench.join_with(1);
  bench.list(1, 1);  // is read already
  bench.list(1, 2);
  bench.piece(1, 3);  // is read already
  bench.piece(1, 4);
  const RightsActor console;
  const DefineRole blind{{"blind", {}, 0, 0, 0}};
  REQUIRE(bench.server.changes().change_rights(blind, console, 0, bench.now()));
  REQUIRE(bench.server.changes().change_rights(SetDefaultRole{"blind"}, console, 0, bench.now()));
  bench.answer_list(build_of(0));
  bench.answer_piece(Bytes(1, 1));
  bench.tick();
  CHECK(bench.environment.list_requests.empty());
  CHECK(bench.environment.piece_requests.empty());
  CHECK(bench.lists(1).empty());
  CHECK(bench.pieces(1).empty());
}

}  // namespace runstone
