#include "server/world/library/build_uploads.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/unit/server/world/cluster/cluster_bench.hpp"

namespace runstone {
namespace {

using namespace test;

constexpr std::uint64_t kUploadedBytes = kBuildUploadBytesMax + 1'000;

WorldConfig upload_config() {
  WorldConfig c = config();
  c.library.file_bytes_max = 4 << 20;
  return c;
}

struct UploadsBench : WorldBench {
  explicit UploadsBench(const WorldConfig& c = upload_config()) : WorldBench(c) {}

  AuthorId join_with(SessionId session, AddressBlock from = {}) {
    return join(session, static_cast<std::uint8_t>(session), 1, from, kFeatureBuilds).author;
  }
  void offer(SessionId session, std::uint32_t request, std::uint64_t bytes = kUploadedBytes) {
    server.received(session, BuildOffer{request, bytes}, now());
  }
  void upload(SessionId session, std::uint32_t request, std::uint64_t offset, std::size_t count) {
    server.received(session, BuildUpload{request, offset, Bytes(count, 7)}, now());
  }
  void upload_all(SessionId session, std::uint32_t request) {
    upload(session, request, 0, kBuildUploadBytesMax);
    upload(session, request, kBuildUploadBytesMax, kUploadedBytes - kBuildUploadBytesMax);
  }
  /// Answers the oldest verification with a build that claims another author.
  void verify(const std::string& error = "") {
    REQUIRE_FALSE(environment.builds_to_verify.empty());
    const auto verified = environment.builds_to_verify.front();
    environment.builds_to_verify.pop_front();
    if (!error.empty()) {
      server.build_uploads().verified(verified.upload, failure(error), now());
      return;
    }
    auto file = std::make_shared<Bytes>();
    for (const Bytes& part : verified.parts) file->insert(file->end(), part.begin(), part.end());
    VerifiedBuild build;
    build.build.info.name = "Mill";
    build.build.info.author = "somebody else";
    build.build.file_bytes = file->size();
    build.file = std::move(file);
    server.build_uploads().verified(verified.upload, std::move(build), now());
  }
  void save(const std::string& error = "") {
    REQUIRE_FALSE(environment.builds_to_save.empty());
    const UploadNumber upload = environment.builds_to_save.front().upload;
    environment.builds_to_save.pop_front();
    server.build_uploads().saved(upload, error, now());
  }
  std::vector<BuildAnswer> answers(SessionId session) const {
    return environment.messages<BuildAnswer>(session, kEdge);
  }
  BuildAnswer answer(SessionId session) const {
    const auto all = answers(session);
    REQUIRE_FALSE(all.empty());
    return all.back();
  }
  std::string refusal(SessionId session) const { return answer(session).refusal; }
  void set_default_role(const RightSet& rights) {
    const RightsActor console;
    REQUIRE(
        server.changes().change_rights(DefineRole{{"guest", rights, 0, 0, 0}}, console, 0, now()));
    REQUIRE(server.changes().change_rights(SetDefaultRole{"guest"}, console, 0, now()));
  }
  std::vector<AddBuild> added() const {
    std::vector<AddBuild> builds;
    for (const EditRecord& record : environment.records) {
      const LibraryChange* change = library_change_of(record.edit);
      if (change != nullptr) builds.push_back(std::get<AddBuild>(*change));
    }
    return builds;
  }
};

}  // namespace

TEST_CASE("a player adds a build, and gets its number when it is on disk", "[world][library]") {
  UploadsBench bench;
  const AuthorId author = bench.join_with(1);
  bench.offer(1, 3);
  CHECK(bench.answer(1) == BuildAnswer{3, 0, 0, ""});
  bench.upload_all(1, 3);
  REQUIRE(bench.answers(1).size() == 3);
  CHECK(bench.answers(1)[1] == BuildAnswer{3, kBuildUploadBytesMax, 0, ""});
  CHECK(bench.answers(1)[2] == BuildAnswer{3, kUploadedBytes, 0, ""});
  bench.verify();
  REQUIRE(bench.environment.builds_to_save.size() == 1);
  CHECK(bench.environment.builds_to_save[0].file->size() == kUploadedBytes);
  CHECK(bench.environment.builds_to_save[0].content != 0);
  CHECK(bench.added().empty());
  bench.save();
  REQUIRE(bench.added().size() == 1);
  CHECK(bench.added()[0].info.name == "Mill");
  CHECK(bench.added()[0].info.author == "player1");  // and not the one that the file claims
  CHECK(bench.added()[0].file_bytes == kUploadedBytes);
  const EditRecord& record = bench.environment.records.back();
  CHECK(record.op.author == author);
  CHECK(bench.answers(1).size() == 3);
  bench.server.durable(record.version.seq, bench.now());
  CHECK(bench.answer(1) == BuildAnswer{3, kUploadedBytes, record.version.seq, ""});
  CHECK(bench.environment.removed_files.empty());
  CHECK(bench.environment.closed.empty());
}

TEST_CASE("an offer is refused without the right, and above the limits", "[world][library]") {
  WorldConfig c = upload_config();
  c.library.builds_per_player = 1;
  UploadsBench bench(c);
  bench.join_with(1);
  bench.offer(1, 1, (4 << 20) + 1);
  CHECK(bench.refusal(1) ==
        "the build takes 5 MiB, and one of at most 4 MiB is allowed (build_mib): divide it");
  bench.offer(1, 2, std::uint64_t{4} << 20);
  CHECK(bench.refusal(1).empty());
  bench.offer(1, 3);
  bench.upload_all(1, 3);
  bench.verify();
  bench.save();
  bench.offer(1, 4);
  CHECK(bench.refusal(1).find("builds_per_player") != std::string::npos);
  bench.set_default_role({Right::see});
  bench.offer(1, 5);
  CHECK(bench.refusal(1) == "your role does not allow to build, so you may not add builds");
  bench.set_default_role({Right::see, Right::build});
  bench.join_with(2);
  bench.server.set_disk_is_full(true, bench.now());
  bench.offer(2, 1);
  CHECK(bench.refusal(2) == kDiskIsFull);
  CHECK(bench.added().size() == 1);
}

TEST_CASE("rights and limits hold again before the file is written, and when the build is added",
          "[world][library]") {
  UploadsBench bench;
  bench.join_with(1);
  bench.offer(1, 1);
  bench.upload_all(1, 1);
  bench.set_default_role({Right::see});
  bench.verify();
  CHECK(bench.environment.builds_to_save.empty());
  CHECK(bench.answer(1) ==
        BuildAnswer{1, kUploadedBytes, 0,
                    "your role does not allow to build, so you may not add builds"});

  bench.set_default_role({Right::see, Right::build});
  bench.offer(1, 2);
  bench.upload_all(1, 2);
  bench.verify();
  REQUIRE(bench.environment.builds_to_save.size() == 1);
  const std::uint64_t content = bench.environment.builds_to_save[0].content;
  bench.set_default_role({Right::see});
  bench.save();
  CHECK_FALSE(bench.refusal(1).empty());
  CHECK(bench.environment.removed_files == std::vector<std::uint64_t>{content});
  CHECK(bench.added().empty());
}

TEST_CASE("a file that is not sound, or cannot be written, is refused with the reason",
          "[world][library]") {
  UploadsBench bench;
  bench.join_with(1);
  bench.offer(1, 1);
  bench.upload_all(1, 1);
  bench.verify("the file is no sound .rsb");
  CHECK(bench.answer(1) == BuildAnswer{1, kUploadedBytes, 0, "the file is no sound .rsb"});
  CHECK(bench.environment.builds_to_save.empty());
  bench.offer(1, 2);
  bench.upload_all(1, 2);
  bench.verify();
  bench.save("disk is full");
  CHECK(bench.refusal(1) == "disk is full");
  CHECK(bench.environment.removed_files.size() == 1);
  CHECK(bench.added().empty());
  bench.offer(1, 3);
  CHECK(bench.refusal(1).empty());
}

TEST_CASE("bytes out of order, too many, or for no offer are ignored", "[world][library]") {
  UploadsBench bench;
  bench.join_with(1);
  bench.upload(1, 1, 0, 10);
  CHECK(bench.answers(1).empty());
  bench.offer(1, 2, 100);
  bench.upload(1, 1, 0, 10);   // of another offer
  bench.upload(1, 2, 1, 10);   // leaves a gap
  bench.upload(1, 2, 0, 101);  // more than was offered
  CHECK(bench.answers(1).size() == 1);
  bench.upload(1, 2, 0, 10);
  bench.upload(1, 2, 0, 10);  // again
  CHECK(bench.answers(1).size() == 2);
  bench.upload(1, 2, 10, 90);
  bench.upload(1, 2, 100, 1);  // behind the end
  CHECK(bench.answers(1).size() == 3);
  CHECK(bench.environment.builds_to_verify.size() == 1);
  CHECK(bench.environment.closed.empty());
}

TEST_CASE("another offer ends the one before, and nothing of its file is kept",
          "[world][library]") {
  UploadsBench bench;
  bench.join_with(1);
  bench.offer(1, 1);
  bench.upload(1, 1, 0, 10);
  bench.offer(1, 2);
  CHECK(bench.answer(1) == BuildAnswer{2, 0, 0, ""});
  bench.upload(1, 1, 10, 10);
  CHECK(bench.answer(1) == BuildAnswer{2, 0, 0, ""});
  bench.upload_all(1, 2);
  // While the server has the whole file, another one of the player has no room.
  bench.offer(1, 3);
  CHECK(bench.refusal(1) == "a build that you add is under way: wait until it is done");
  bench.verify();  // the offer has ended
  CHECK(bench.environment.builds_to_save.empty());
  bench.offer(1, 4);
  CHECK(bench.refusal(1).empty());
}

TEST_CASE("the end of a session ends its offer at every step", "[world][library]") {
  UploadsBench bench;
  bench.join_with(1);
  bench.offer(1, 1);
  bench.server.disconnected(1);

  bench.join_with(2);
  bench.offer(2, 1);
  bench.upload_all(2, 1);
  bench.server.disconnected(2);
  bench.verify();
  CHECK(bench.environment.builds_to_save.empty());

  bench.join_with(3);
  bench.offer(3, 1);
  bench.upload_all(3, 1);
  bench.verify();
  const std::uint64_t content = bench.environment.builds_to_save.at(0).content;
  bench.server.disconnected(3);
  bench.save();
  CHECK(bench.environment.removed_files == std::vector<std::uint64_t>{content});
  CHECK(bench.added().empty());

  // Whoever comes next finds room.
  for (SessionId session = 4; session <= 5; ++session) {
    bench.join_with(session);
    bench.offer(session, 1);
    CHECK(bench.refusal(session).empty());
  }
}

TEST_CASE("two files of all sessions are taken at a time, and one of a key or an address",
          "[world][library]") {
  UploadsBench bench;
  const AddressBlock household = address_block_v4(0x5001'0203);
  bench.join_with(1, household);
  bench.join_with(2, household);
  bench.join_with(3);
  bench.join_with(4);
  bench.join(5, 1, 2, {}, kFeatureBuilds);  // another client of the first player
  bench.offer(1, 1);
  bench.offer(2, 1);
  CHECK(bench.refusal(2) == "a build from your address is being added: try again when it is done");
  bench.offer(5, 1);
  CHECK(bench.refusal(5) == "a build that you add is under way: wait until it is done");
  bench.offer(3, 1);
  CHECK(bench.refusal(3).empty());
  bench.offer(4, 1);
  CHECK(bench.refusal(4) == "other players are adding builds: try again in a minute");
  bench.server.disconnected(1);
  bench.offer(4, 2);
  CHECK(bench.refusal(4).empty());
}

TEST_CASE("an offer ends when no byte comes, and when the file comes too slowly",
          "[world][library]") {
  UploadsBench bench;
  bench.join_with(1);
  bench.offer(1, 1);
  bench.tick(kUploadSilenceUs - 1);
  CHECK(bench.refusal(1).empty());
  bench.tick(1);
  CHECK(bench.answer(1) == BuildAnswer{1, 0, 0, "no byte of the file came for 30 s"});

  // It kept its place from others for 30 s.
  bench.offer(1, 2);
  CHECK(bench.refusal(1) ==
        "your last file was not added and kept others waiting: try again in 30 s");
  bench.tick(kUploadSilenceUs);
  bench.offer(1, 2, kUploadBytesPerSecond * 10);
  std::uint64_t received = 0;
  while (bench.refusal(1).empty() && received < 100) {
    bench.tick(10'000'000 - 1);
    bench.upload(1, 2, received++, 1);
  }
  CHECK(received == 5);  // 40 s have passed
  CHECK(bench.refusal(1) == "the file came too slowly: at least 32 KiB each second are needed");
}

TEST_CASE("an offer that is ended soon lets the player offer again at once", "[world][library]") {
  UploadsBench bench;
  bench.join_with(1);
  bench.offer(1, 1);
  bench.upload(1, 1, 0, 100);
  bench.tick(1'000'000);
  bench.offer(1, 2);  // ends the first one
  CHECK(bench.answer(1) == BuildAnswer{2, 0, 0, ""});
  bench.upload_all(1, 2);
  bench.verify("it is damaged");
  bench.offer(1, 3);
  CHECK(bench.answer(1) == BuildAnswer{3, 0, 0, ""});
}

TEST_CASE("a file waits for the log writer, and not for ever", "[world][library]") {
  WorldConfig c = upload_config();
  c.idle_us_max = kUploadWriterUs * 2;
  UploadsBench bench(c);
  bench.join_with(1);
  bench.environment.is_file_writer_busy = true;
  bench.offer(1, 1);
  bench.upload_all(1, 1);
  bench.verify();
  bench.tick();
  CHECK(bench.environment.builds_to_save.empty());
  bench.environment.is_file_writer_busy = false;
  bench.tick();
  CHECK(bench.environment.builds_to_save.size() == 1);
  bench.save();
  CHECK(bench.added().size() == 1);

  bench.environment.is_file_writer_busy = true;
  bench.offer(1, 2);
  bench.upload_all(1, 2);
  bench.verify();
  bench.tick(kUploadWriterUs - 1);
  CHECK(bench.refusal(1).empty());
  bench.tick(1);
  CHECK(bench.refusal(1) ==
        "other files are being written, or the world cannot be written: try again");
}

TEST_CASE("a log that fails before the record is on disk is a refusal", "[world][library]") {
  UploadsBench bench;
  bench.join_with(1);
  bench.offer(1, 1);
  bench.upload_all(1, 1);
  bench.verify();
  bench.save();
  bench.server.log_failed();
  CHECK(bench.answer(1) == BuildAnswer{1, kUploadedBytes, 0, "the log cannot be written any more"});
}

TEST_CASE("no build is added while a server of an older version follows",
          "[world][library][servers]") {
  UploadsBench bench;
  bench.join_with(1);
  constexpr SessionId kOldServer = 9;
  bench.server.connected(kOldServer, bench.now());
  Hello hello = bench.hello(200, kOldServer);  // the world's own key
  hello.features = kFeatureServers;
  bench.server.received(kOldServer, hello, bench.now());
  const Welcome welcome = bench.environment.messages<Welcome>(kOldServer, 0).at(0);
  bench.server.received(kOldServer, bench.client_auth(200, hello, welcome), bench.now());
  REQUIRE(bench.server.cluster().follower_count() == 1);
  bench.offer(1, 1);
  CHECK(bench.refusal(1).find("a server that follows is of an older version") == 0);
  bench.server.disconnected(kOldServer);
  bench.offer(1, 2);
  CHECK(bench.refusal(1).empty());
}

TEST_CASE("a server that follows answers reads itself and takes no builds", "[world][library]") {
  ClusterBench bench;
  AddBuild build;
  build.info.name = "Mill";
  build.file_bytes = 100;
  REQUIRE(bench.world(0).changes().add_build(build, 0, bench.now()).has_value());
  bench.run();
  bench.join(1, 9, 3);
  bench.receive(1, 9, BuildsRequest{});
  REQUIRE(bench.environment(1).list_requests.size() == 1);
  bench.world(1).build_reads().found(9, 1, FoundBuilds{}, bench.now());
  REQUIRE(bench.sent<Builds>(1, 9).size() == 1);
  CHECK(bench.sent<Builds>(1, 9)[0].total == 1);
  bench.receive(1, 9, BuildPieceRequest{2, 1, 0});
  CHECK(bench.environment(1).piece_requests.size() == 1);
  bench.receive(1, 9, BuildOffer{3, 10});
  bench.run();
  REQUIRE(bench.sent<BuildAnswer>(1, 9).size() == 1);
  CHECK(bench.sent<BuildAnswer>(1, 9)[0].refusal ==
        "this server follows the owner of the world: add builds there (servers lists them)");
  CHECK(bench.environment(0).list_requests.empty());
}

}  // namespace runstone
