#include "bindings/web/carried_session.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "protocol/codec/frame.hpp"
#include "tests/support/codec/test_keys.hpp"
#include "tests/unit/client/session/session_bench.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

/// A carried session, and the server that the test plays for it, with frames between them.
struct CarriedBench {
  static CarriedPlayer player() {
    CarriedPlayer out;
    out.seed.fill(3);
    out.name = "ada";
    out.instance = 42;
    out.radius_h = out.radius_v = 1;
    return out;
  }

  /// Returns the messages of the session, as the server reads them. Each frame is a message of a
  /// WebSocket.
  std::vector<Message> sent() {
    std::vector<Message> messages;
    for (ByteView frame = session.next_frame(); !frame.empty(); frame = session.next_frame()) {
      const auto read =
          from_client.feed(frame, [&](MessageKind kind, ByteView body) -> Result<void> {
            auto message = decode_message(Sender::client, kind, body, session_bench::kEdge);
            REQUIRE(message.has_value());
            messages.push_back(*std::move(message));
            return {};
          });
      REQUIRE(read.has_value());
    }
    return messages;
  }
  Result<void> give(const Message& message) {
    Bytes frames;
    to_client.append(encode_message(message), frames);
    return session.receive(frames, now += 1'000);
  }
  std::vector<CarriedNotice> notices() {
    std::vector<CarriedNotice> out;
    while (auto next = session.next_notice()) out.push_back(*std::move(next));
    return out;
  }

  void open() {
    session.connected({5}, now);
    const auto hellos = session_bench::take<Hello>(sent());
    REQUIRE(hellos.size() == 1);
    server.hello = hellos[0];
    REQUIRE(give(server.make_welcome()).has_value());
    REQUIRE(session_bench::take<ClientAuth>(sent()).size() == 1);
    REQUIRE(give(SessionAccepted{6, server.resolved}).has_value());
    REQUIRE(session.session().is_open());
  }
  /// Answers the newest view with all of its chunks.
  void load() {
    session.step(now += 10'000);
    const auto views = session_bench::take<View>(sent());
    REQUIRE(!views.empty());
    const View& view = views.back();
    for (std::int32_t x = -1; x <= 1; ++x) {
      for (std::int32_t y = -1; y <= 1; ++y) {
        for (std::int32_t z = -1; z <= 1; ++z) {
          const ChunkCoord at{view.centre.x + x, view.centre.y + y, view.centre.z + z};
          if (!view.contains(at)) continue;
          REQUIRE(give(chunks_of(server.world.snapshot(at), view.number)).has_value());
        }
      }
    }
  }
  /// Returns the quads of each chunk whose mesh was made, and 0 for those that have none any more.
  std::map<ChunkCoord, std::size_t> meshes() {
    std::map<ChunkCoord, std::size_t> out;
    while (const auto next = session.next_mesh())
      out[next->at] = next->mesh ? next->mesh->quad_count() : 0;
    return out;
  }

  CarriedSession session{player()};
  session_bench::Server server;
  FrameReader from_client{Sender::client};
  FrameWriter to_client;
  TimeUs now = 1'000'000;
};

CarriedNoticeKind kind_of_last(const std::vector<CarriedNotice>& notices) {
  REQUIRE(!notices.empty());
  return notices.back().kind;
}

}  // namespace

TEST_CASE("a carried session joins, loads its view and meshes it once", "[web_core]") {
  CarriedBench bench;
  bench.open();
  const auto notices = bench.notices();
  REQUIRE(notices.size() == 2);
  CHECK(notices[0].kind == CarriedNoticeKind::materials);
  CHECK(notices[0].number == default_material_table().size());
  CHECK(notices[1].kind == CarriedNoticeKind::opened);

  bench.load();
  CHECK(bench.session.session().loaded());
  // All voxels below y = 0 are stone. Each of the five columns shows a quad to the top, and quads
  // at the sides and the bottom of the view.
  const auto meshes = bench.meshes();
  CHECK(meshes.size() == 5);
  for (const auto& [at, quads] : meshes) {
    CHECK(at.y == -1);
    CHECK(quads >= 1);
  }
  CHECK(bench.meshes().empty());
  CHECK(bench.session.unmeshed_count() == 0);
}

TEST_CASE("an edit of a carried session is shown, sent, rejected and taken back", "[web_core]") {
  CarriedBench bench;
  bench.open();
  bench.load();
  bench.meshes();
  bench.notices();

  const auto number = bench.session.edit(session_bench::set({3, 0, 3}, 1), bench.now);
  REQUIRE(number.has_value());
  CHECK(bench.session.session().replica().shown_at({3, 0, 3}) == Material{1});
  bench.session.step(bench.now += 2'000'000);  // edits wait for the clock of the server
  const auto requests = session_bench::take<EditRequest>(bench.sent());
  REQUIRE(requests.size() == 1);
  CHECK(requests[0].client_seq == *number);
  auto meshes = bench.meshes();
  CHECK(meshes.at({0, 0, 0}) == 5);

  REQUIRE(bench.give(Reject{*number, RejectReason::busy, "too busy"}).has_value());
  bench.session.step(bench.now += 10'000);
  const auto notices = bench.notices();
  CHECK(kind_of_last(notices) == CarriedNoticeKind::rejected);
  CHECK(notices.back().number == *number);
  CHECK(notices.back().text == "too busy");
  meshes = bench.meshes();
  CHECK(meshes.at({0, 0, 0}) == 0);

  // A material that the world lacks is refused with words, and nothing is sent.
  const auto refused = bench.session.edit(session_bench::set({3, 0, 3}, 60'000), bench.now);
  REQUIRE_FALSE(refused.has_value());
  CHECK_FALSE(refused.error().empty());
}

TEST_CASE("a command of a carried session has its output in a notice", "[web_core]") {
  CarriedBench bench;
  CHECK_FALSE(bench.session.command("undo").has_value());
  bench.server.features = kFeatureCommands;
  bench.open();
  bench.notices();
  const auto send = [&](const std::string& text) {
    REQUIRE(bench.session.command(text).has_value());
    const auto requests = session_bench::take<CommandRequest>(bench.sent());
    REQUIRE(requests.size() == 1);
    CHECK(requests[0].text == text);
    return requests[0].id;
  };
  const std::uint32_t id = send("undo");
  CHECK_FALSE(bench.session.command("undo").has_value());
  REQUIRE(bench.give(CommandOutput{id, {"one edit", "was undone"}, true, true}).has_value());
  bench.session.step(bench.now += 10'000);
  auto notices = bench.notices();
  REQUIRE(notices.size() == 1);
  CHECK(notices[0].kind == CarriedNoticeKind::command);
  CHECK(notices[0].number == 1);
  CHECK(notices[0].text == "one edit\nwas undone");

  send("redo");
  bench.session.disconnected();
  bench.session.step(bench.now += 10'000);
  notices = bench.notices();
  const auto ended = std::find_if(notices.begin(), notices.end(), [](const CarriedNotice& notice) {
    return notice.kind == CarriedNoticeKind::command;
  });
  REQUIRE(ended != notices.end());
  CHECK(ended->number == 0);
  CHECK_FALSE(ended->text.empty());
}

TEST_CASE("an edit that is offered again keeps its number in the notices", "[web_core]") {
  CarriedBench bench;
  bench.open();
  bench.load();
  bench.session.disconnected();
  const auto number = bench.session.edit(session_bench::set({3, 0, 3}, 1), bench.now);
  REQUIRE(number.has_value());
  bench.from_client = FrameReader(Sender::client);
  bench.to_client = FrameWriter();
  bench.now += 10'000;
  bench.open();
  bench.load();
  bench.notices();
  bench.session.step(bench.now += 2'000'000);  // edits wait for the clock of the server
  auto requests = session_bench::take<EditRequest>(bench.sent());
  REQUIRE(requests.size() == 1);
  CHECK(requests[0].client_seq == *number);

  REQUIRE(bench.give(Reject{*number, RejectReason::busy, "the log is full"}).has_value());
  bench.session.step(bench.now += 10'000);
  CHECK(bench.notices().empty());
  bench.session.step(bench.now += 2'000'000);
  requests = session_bench::take<EditRequest>(bench.sent());
  REQUIRE(requests.size() == 1);
  CHECK(requests[0].client_seq != *number);

  const Reject second{requests[0].client_seq, RejectReason::not_permitted, "not here"};
  REQUIRE(bench.give(second).has_value());
  bench.session.step(bench.now += 10'000);
  const auto notices = bench.notices();
  REQUIRE(notices.size() == 1);
  CHECK(notices[0].kind == CarriedNoticeKind::rejected);
  CHECK(notices[0].number == *number);
  CHECK(notices[0].text == "not here");
}

TEST_CASE("a carried session drops the meshes of chunks that leave its view", "[web_core]") {
  CarriedBench bench;
  bench.open();
  bench.load();
  bench.meshes();
  bench.session.move({1000.5, 0.5, 0.5}, 0, 0);
  const auto gone = bench.meshes();
  CHECK(gone.size() == 5);
  for (const auto& [at, quads] : gone) CHECK(quads == 0);
  bench.load();
  CHECK(bench.meshes().size() == 5);
}

TEST_CASE("a carried session that was moved before its world opens has its view there",
          "[web_core]") {
  CarriedBench bench;
  bench.session.move({1000.5, 0.5, 0.5}, 0, 0);
  bench.open();
  bench.session.step(bench.now += 10'000);
  const auto views = session_bench::take<View>(bench.sent());
  REQUIRE(!views.empty());
  CHECK(views.back().centre == chunk_of({1000, 0, 0}, session_bench::kEdge));
}

TEST_CASE("a carried session says why a connection ended, and begins another one", "[web_core]") {
  CarriedBench bench;
  REQUIRE_FALSE(bench.session.receive(Bytes{1, 2, 3}, bench.now).has_value());
  bench.open();
  bench.notices();
  Bytes noise(64, 0xff);
  CHECK_FALSE(bench.session.receive(noise, bench.now).has_value());
  bench.session.disconnected();
  CHECK(kind_of_last(bench.notices()) == CarriedNoticeKind::closed);
  CHECK_FALSE(bench.session.wants_close());
  CHECK(bench.session.next_frame().empty());

  bench.from_client = FrameReader(Sender::client);
  bench.to_client = FrameWriter();
  bench.open();
  // The materials are the same as before.
  const auto notices = bench.notices();
  REQUIRE(notices.size() == 1);
  CHECK(notices[0].kind == CarriedNoticeKind::opened);
  REQUIRE(bench.give(Goodbye{GoodbyeReason::not_admitted, "grief"}).has_value());
  bench.session.disconnected();
  const auto end = bench.notices();
  CHECK(kind_of_last(end) == CarriedNoticeKind::refused);
  CHECK(end.back().text.find("grief") != std::string::npos);

  bench.session.leave();
  CHECK_FALSE(bench.session.wants_close());
}
