#include "client/session/voxel_author.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test::voxel_author_test {

using namespace session_bench;

namespace {

using Sight = VoxelAuthor::Sight;

constexpr TimeUs kSecond = 1'000'000;
constexpr Sight kStone{{1, 2, 3}, 1, {1, 8}};

/// Answers with a mark of the author 7.
LogMarks answer(const LogMarksRequest& request, Sequence seq = 5) {
  LogMarks out;
  out.request = request.request;
  out.marks = {{seq, 1'000, 7, Cause::player, EditKind::fill_box}};
  out.authors = {{7, "ann"}};
  return out;
}

struct AuthorBench {
  /// Looks for so long, in steps of 10 ms. Returns the requests.
  std::vector<LogMarksRequest> look(const std::optional<Sight>& sight, TimeUs for_us,
                                    bool may_send = true) {
    std::vector<LogMarksRequest> out;
    for (const TimeUs end = now + for_us; now < end; now += 10'000) {
      if (const auto request = author.look(sight, may_send, now)) out.push_back(*request);
    }
    return out;
  }
  VoxelAuthor author;
  TimeUs now = 100 * kSecond;
};

}  // namespace

TEST_CASE("the author of a voxel is asked for once the crosshair rests on it", "[client_session]") {
  AuthorBench bench;
  CHECK(bench.look(kStone, VoxelAuthor::kRestUs).empty());
  CHECK(bench.look(Sight{{2, 2, 3}, 1, {1, 8}}, VoxelAuthor::kRestUs).empty());
  CHECK(bench.look(kStone, VoxelAuthor::kRestUs).empty());
  const auto requests = bench.look(kStone, 3 * kSecond);
  REQUIRE(requests.size() == 1);  // the answer is waited for
  CHECK(requests[0] ==
        LogMarksRequest{VoxelAuthor::kFirstRequest, 1, kSequenceMax, 1, VoxelPos{1, 2, 3}});
  CHECK(bench.author.found() == nullptr);
  CHECK_FALSE(bench.author.receive(answer({1, 1, 1, 1})));
  REQUIRE(bench.author.receive(answer(requests[0])));
  REQUIRE(bench.author.found() != nullptr);
  CHECK(bench.author.found()->author == "ann");
  CHECK(bench.author.found()->mark.seq == 5);
  CHECK(bench.look(kStone, 3 * kSecond).empty());  // the answer is kept
  bench.look(std::nullopt, kSecond);
  CHECK(bench.author.found() == nullptr);
  CHECK(bench.look(kStone, 3 * kSecond).empty());
  CHECK(bench.author.found() != nullptr);
}

TEST_CASE("a newer version of the chunk is asked about, at most once a second",
          "[client_session]") {
  AuthorBench bench;
  Sight sight = kStone;
  std::size_t requests = 0;
  for (int i = 0; i < 50; ++i, ++sight.version.seq) {
    for (const LogMarksRequest& request : bench.look(sight, kSecond / 10)) {
      ++requests;
      bench.author.receive(answer(request, sight.version.seq));
    }
  }
  CHECK(requests >= 4);
  CHECK(requests <= 5);
  REQUIRE(bench.author.found() != nullptr);  // an older answer stays while the material does
  sight.material = 2;
  bench.look(sight, 10'000);
  CHECK(bench.author.found() == nullptr);
}

TEST_CASE("another author is shown after another voxel, another material or an answer alone",
          "[client_session]") {
  AuthorBench bench;
  CHECK(bench.author.take_changed());
  CHECK(bench.look(std::nullopt, kSecond).empty());
  CHECK_FALSE(bench.author.take_changed());
  const auto requests = bench.look(kStone, kSecond);
  REQUIRE(requests.size() == 1);
  CHECK(bench.author.take_changed());
  CHECK_FALSE(bench.author.take_changed());
  bench.author.receive(answer(requests[0]));
  CHECK(bench.author.take_changed());
  Sight sight = kStone;
  ++sight.version.seq;
  bench.look(sight, kSecond / 10);
  CHECK_FALSE(bench.author.take_changed());  // the answer stays while the material does
  sight.material = 2;
  bench.look(sight, kSecond / 10);
  CHECK(bench.author.take_changed());
  sight.at.x = 7;
  bench.look(sight, kSecond / 10);
  CHECK(bench.author.take_changed());
  bench.look(std::nullopt, kSecond / 10);
  CHECK(bench.author.take_changed());
  bench.author.clear();
  CHECK(bench.author.take_changed());
}

TEST_CASE("no author is asked for while something else is, and a lost answer is asked for again",
          "[client_session]") {
  AuthorBench bench;
  CHECK(bench.look(kStone, 2 * kSecond, false).empty());
  CHECK(bench.look(kStone, kSecond).size() == 1);
  CHECK(bench.look(kStone, VoxelAuthor::kAnswerUsMax).size() == 1);
  LogMarks none;
  none.request = VoxelAuthor::kFirstRequest + 1;
  CHECK(bench.author.receive(none));
  CHECK(bench.author.found() == nullptr);
  CHECK(bench.look(kStone, 3 * kSecond).empty());  // nobody has set it: that is known, too
}

TEST_CASE_METHOD(SessionBench, "a session asks for authors of confirmed voxels with the feature",
                 "[session]") {
  const auto requests = [this] {
    std::size_t count = 0;
    for (int i = 0; i < 200; ++i, now += 10'000) {
      session.step_voxel_author(VoxelPos{1, -1, 1}, now);
      count += take<LogMarksRequest>(sent()).size();
    }
    return count;
  };
  server.features = kFeatureLogMarks;
  static_cast<void>(open());
  receive(chunks_of(server.world.snapshot({0, -1, 0})));
  CHECK(requests() == 0);
  session.disconnected();
  server.features = kFeatureLogMarks | kFeatureVoxelAuthors;
  static_cast<void>(open());
  receive(chunks_of(server.world.snapshot({0, -1, 0})));
  CHECK(requests() == 1);
  LogMarksRequest asked;
  asked.request = VoxelAuthor::kFirstRequest;
  receive(answer(asked));
  REQUIRE(session.voxel_author().found() != nullptr);
  CHECK(session.timeline().band().empty());  // the timeline ignores the answer
  REQUIRE(session.offer(set({1, -1, 1}, 2), now, now));
  session.step_voxel_author(VoxelPos{1, -1, 1}, now);
  CHECK(session.voxel_author().found() == nullptr);  // the server does not have it yet
}

}  // namespace runstone::test::voxel_author_test
