#include "client/session/library_exchange.hpp"

#include <catch2/catch.hpp>
#include <utility>

#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test::session_bench {
namespace {

ListedBuild listed_build(Sequence number, std::uint64_t file_bytes = 1000) {
  ListedBuild out;
  out.number = number;
  out.info.name = "mill " + std::to_string(number);
  out.file_bytes = file_bytes;
  return out;
}

/// Returns bytes of which no two pieces are equal.
Bytes some_file(std::size_t bytes) {
  Bytes out(bytes);
  for (std::size_t i = 0; i < bytes; ++i)
    out[i] = static_cast<std::uint8_t>(i * 7 + (i >> 8) + (i >> 16) * 3);
  return out;
}

struct ExchangeBench {
  /// Returns the messages of one kind of this step. Others may not be there.
  template <class T>
  std::vector<T> step() {
    const auto messages = exchange.step(now);
    auto out = take<T>(messages);
    REQUIRE(out.size() == messages.size());
    return out;
  }
  void list_one(Sequence number, std::uint64_t file_bytes) {
    exchange.list({});
    Builds answer;
    answer.request = step<BuildsRequest>().at(0).request;
    answer.builds = {listed_build(number, file_bytes)};
    answer.total = 1;
    exchange.receive(answer, now);
  }
  void answer(const BuildPieceRequest& request, const Bytes& file) {
    const auto first = file.begin() + static_cast<std::ptrdiff_t>(request.offset);
    const auto count = std::min<std::size_t>(kBuildPieceBytes, file.size() - request.offset);
    exchange.receive(
        BuildPiece{request.request, {first, first + static_cast<std::ptrdiff_t>(count)}, {}}, now);
  }
  LibraryExchange exchange;
  TimeUs now = 1'000'000;
};

}  // namespace

TEST_CASE_METHOD(ExchangeBench, "builds are listed by what they have, page after page",
                 "[client_session]") {
  exchange.list({"mill", "ana", "wood"});
  const auto first = step<BuildsRequest>();
  REQUIRE(first.size() == 1);
  CHECK(first[0].name == "mill");
  CHECK(first[0].author == "ana");
  CHECK(first[0].tag == "wood");
  CHECK(first[0].before == kSequenceMax);
  CHECK(first[0].count == kListedBuildsMax);
  CHECK(exchange.listing().is_waiting);
  CHECK(step<BuildsRequest>().empty());
  exchange.receive(Builds{first[0].request + 7, {listed_build(9)}, false, 1, {}}, now);
  CHECK(exchange.listing().is_waiting);
  exchange.receive(Builds{first[0].request, {listed_build(9), listed_build(7)}, true, 3, {}}, now);
  CHECK_FALSE(exchange.listing().is_waiting);
  CHECK(exchange.listing().has_more);
  CHECK(exchange.listing().total == 3);
  exchange.list_more();
  const auto second = step<BuildsRequest>();
  REQUIRE(second.size() == 1);
  CHECK(second[0].before == 7);
  CHECK(second[0].name == "mill");
  exchange.receive(Builds{second[0].request, {listed_build(2)}, false, 3, {}}, now);
  REQUIRE(exchange.listing().builds.size() == 3);
  CHECK(exchange.listing().builds[2].number == 2);
  exchange.list_more();
  CHECK(step<BuildsRequest>().empty());
  CHECK_FALSE(exchange.is_busy());
}

TEST_CASE_METHOD(ExchangeBench, "a listing that is refused, repeated or lost says why",
                 "[client_session]") {
  exchange.list({});
  const auto asked = step<BuildsRequest>().at(0);
  exchange.receive(Builds{asked.request, {}, false, 0, "this needs the right see"}, now);
  CHECK(exchange.listing().refusal == "this needs the right see");
  exchange.list({});
  exchange.receive(Builds{step<BuildsRequest>().at(0).request, {listed_build(9)}, true, 2, {}},
                   now);
  exchange.list_more();
  exchange.receive(Builds{step<BuildsRequest>().at(0).request, {listed_build(9)}, true, 2, {}},
                   now);
  CHECK(exchange.listing().refusal == "the server sent builds again that are in the list");
  CHECK(exchange.listing().builds.size() == 1);
  exchange.list({});
  CHECK(step<BuildsRequest>().size() == 1);
  now += LibraryExchange::kListUsMax;
  CHECK(step<BuildsRequest>().empty());
  CHECK(exchange.listing().refusal == "the server did not answer in time: try it again");
  exchange.list({});
  exchange.disconnected();
  CHECK(exchange.listing().refusal == "the connection ended");
}

TEST_CASE_METHOD(ExchangeBench, "of two listings the newer one counts", "[client_session]") {
  exchange.list({"a", {}, {}});
  const auto older = step<BuildsRequest>().at(0);
  exchange.list({"b", {}, {}});
  exchange.receive(Builds{older.request, {listed_build(5)}, false, 1, {}}, now);
  CHECK(exchange.listing().is_waiting);
  const auto newer = step<BuildsRequest>().at(0);
  CHECK(newer.name == "b");
  exchange.receive(Builds{newer.request, {listed_build(4)}, false, 1, {}}, now);
  CHECK(exchange.listing().builds.at(0).number == 4);
}

TEST_CASE_METHOD(ExchangeBench, "a file comes in pieces, four of them under way",
                 "[client_session]") {
  const Bytes file = some_file(6 * kBuildPieceBytes + 123);
  list_one(12, file.size());
  exchange.fetch(12);
  std::vector<BuildPieceRequest> open = step<BuildPieceRequest>();
  REQUIRE(open.size() == LibraryExchange::kUnderWayMax);
  for (std::size_t i = 0; i < open.size(); ++i) CHECK(open[i].offset == i * kBuildPieceBytes);
  std::size_t answered = 0;
  while (!open.empty()) {
    CHECK(open[0].number == 12);
    answer(open[0], file);
    open.erase(open.begin());
    ++answered;
    CHECK(exchange.fetched().bytes.size() ==
          std::min<std::size_t>(answered * kBuildPieceBytes, file.size()));
    for (const BuildPieceRequest& next : step<BuildPieceRequest>()) open.push_back(next);
    CHECK(open.size() <= LibraryExchange::kUnderWayMax);
  }
  CHECK(answered == 7);
  REQUIRE(exchange.fetched().state == TransferState::done);
  CHECK(exchange.take_file() == file);
  CHECK(exchange.fetched().state == TransferState::none);
}

TEST_CASE_METHOD(ExchangeBench,
                 "wrong pieces, a refusal, silence and a lost connection end a fetch",
                 "[client_session]") {
  const Bytes file = some_file(3 * kBuildPieceBytes);
  list_one(12, file.size());
  exchange.fetch(12);
  const auto open = step<BuildPieceRequest>();
  REQUIRE(open.size() == 3);
  std::string why;
  SECTION("another piece first") {
    answer(open[1], file);
    why = "the server sent other bytes than those that were asked for";
  }
  SECTION("a short piece") {
    exchange.receive(BuildPiece{open[0].request, {1, 2, 3}, {}}, now);
    why = "the server sent other bytes than those that were asked for";
  }
  SECTION("a refusal") {
    answer(open[0], file);
    exchange.receive(BuildPiece{open[1].request, {}, "the build was removed"}, now);
    why = "the build was removed";
  }
  SECTION("silence") {
    answer(open[0], file);
    now += LibraryExchange::kFetchUsMax;
    CHECK(step<BuildPieceRequest>().empty());
    why = "the server did not answer in time: try it again";
  }
  SECTION("a lost connection") {
    answer(open[0], file);
    exchange.disconnected();
    why = "the connection ended";
  }
  CHECK(exchange.fetched().state == TransferState::failed);
  CHECK(exchange.fetched().refusal == why);
  CHECK(exchange.fetched().bytes.empty());
  CHECK_FALSE(exchange.is_busy());
  answer(open[2], file);  // late
  CHECK(exchange.fetched().state == TransferState::failed);
}

TEST_CASE_METHOD(ExchangeBench, "answers to a fetch that was dropped count, and are forgotten",
                 "[client_session]") {
  const Bytes file = some_file(5 * kBuildPieceBytes);
  list_one(12, file.size());
  exchange.fetch(12);
  const auto dropped = step<BuildPieceRequest>();
  REQUIRE(dropped.size() == 4);
  exchange.stop_fetch();
  exchange.fetch(12);
  CHECK(step<BuildPieceRequest>().empty());  // the server answers four at a time
  answer(dropped[0], file);
  CHECK(exchange.fetched().bytes.empty());
  const auto asked = step<BuildPieceRequest>();
  REQUIRE(asked.size() == 1);
  CHECK(asked[0].offset == 0);
  answer(asked[0], file);
  CHECK(exchange.fetched().bytes.size() == kBuildPieceBytes);
}

TEST_CASE_METHOD(ExchangeBench, "a build that is not listed is looked up before its pieces",
                 "[client_session]") {
  exchange.fetch(40);
  const auto asked = step<BuildsRequest>();
  REQUIRE(asked.size() == 1);
  CHECK(asked[0].before == 41);
  CHECK(asked[0].count == 1);
  exchange.list({});  // waits for the look-up, because the server may drop an earlier request
  CHECK(step<BuildsRequest>().empty());
  SECTION("it exists") {
    exchange.receive(Builds{asked[0].request, {listed_build(40, 500)}, true, 3, {}}, now);
    CHECK(exchange.listing().builds.empty());
    const auto messages = exchange.step(now);
    CHECK(take<BuildsRequest>(messages).size() == 1);
    CHECK(take<BuildPieceRequest>(messages).size() == 1);
  }
  SECTION("it does not exist") {
    exchange.receive(Builds{asked[0].request, {listed_build(39, 500)}, true, 3, {}}, now);
    CHECK(exchange.fetched().refusal == "there is no build 40");
  }
}

TEST_CASE_METHOD(ExchangeBench, "a file that is too large is neither fetched nor added",
                 "[client_session]") {
  list_one(12, LibraryExchange::kFileBytesMax + 1);
  exchange.fetch(12);
  CHECK(exchange.fetched().refusal ==
        "the file of the build has 65 MiB; this client takes at most 64 MiB");
  CHECK(exchange.step(now).empty());
  exchange.add(Bytes(LibraryExchange::kFileBytesMax + 1));
  CHECK(exchange.addition().state == TransferState::failed);
  CHECK(exchange.step(now).empty());
}

TEST_CASE_METHOD(ExchangeBench, "a file is sent in uploads, four of them without an answer",
                 "[client_session]") {
  const Bytes file = some_file(9 * kBuildUploadBytesMax + 5);
  exchange.add(file);
  const auto offers = step<BuildOffer>();
  REQUIRE(offers.size() == 1);
  CHECK(offers[0].file_bytes == file.size());
  CHECK(step<BuildUpload>().empty());  // until the offer is accepted
  exchange.receive(BuildAnswer{offers[0].request, 0, 0, {}}, now);
  Bytes received;
  std::vector<BuildUpload> open = step<BuildUpload>();
  CHECK(open.size() == 4);
  while (!open.empty()) {
    CHECK(open[0].request == offers[0].request);
    CHECK(open[0].offset == received.size());
    received.insert(received.end(), open[0].bytes.begin(), open[0].bytes.end());
    open.erase(open.begin());
    exchange.receive(BuildAnswer{offers[0].request, received.size(), 0, {}}, now);
    CHECK(exchange.addition().received_bytes == received.size());
    for (BuildUpload& next : step<BuildUpload>()) open.push_back(std::move(next));
    CHECK(open.size() <= LibraryExchange::kUnderWayMax);
  }
  CHECK(received == file);
  CHECK(exchange.addition().state == TransferState::under_way);  // until it is on the disk
  exchange.receive(BuildAnswer{offers[0].request, file.size(), 77, {}}, now);
  CHECK(exchange.addition().state == TransferState::done);
  CHECK(exchange.addition().number == 77);
}

TEST_CASE_METHOD(ExchangeBench,
                 "a refusal, wrong counts, silence and a lost connection end an addition",
                 "[client_session]") {
  exchange.add(some_file(2 * kBuildUploadBytesMax));
  const std::uint32_t offer = step<BuildOffer>().at(0).request;
  std::string why;
  SECTION("the offer is refused") {
    exchange.receive(BuildAnswer{offer, 0, 0, "you have 200 builds, and may have no more"}, now);
    why = "you have 200 builds, and may have no more";
  }
  SECTION("more bytes than were sent") {
    exchange.receive(BuildAnswer{offer, 1, 0, {}}, now);
    why = "the server counts other bytes than those that were sent";
  }
  SECTION("a number before the end") {
    exchange.receive(BuildAnswer{offer, 0, 0, {}}, now);
    CHECK(step<BuildUpload>().size() == 2);
    exchange.receive(BuildAnswer{offer, kBuildUploadBytesMax, 5, {}}, now);
    why = "the server counts other bytes than those that were sent";
  }
  SECTION("silence") {
    now += LibraryExchange::kAddUsMax;
    CHECK(step<BuildUpload>().empty());
    why = "the server did not answer in time: try it again";
  }
  SECTION("the connection ends before all bytes were sent") {
    exchange.disconnected();
    why = "the connection ended";
  }
  SECTION("the connection ends after all bytes were sent") {
    exchange.receive(BuildAnswer{offer, 0, 0, {}}, now);
    CHECK(step<BuildUpload>().size() == 2);
    exchange.disconnected();
    why = "the connection ended before the answer came: see the list before you add it again";
  }
  CHECK(exchange.addition().state == TransferState::failed);
  CHECK(exchange.addition().refusal == why);
  CHECK(exchange.step(now).empty());
  exchange.receive(BuildAnswer{offer, 2 * kBuildUploadBytesMax, 9, {}}, now);  // late
  CHECK(exchange.addition().state == TransferState::failed);
}

TEST_CASE_METHOD(SessionBench, "a session uses the library only if its server has the feature",
                 "[client_session]") {
  session.library().list({});
  session.step_library(now);
  CHECK(session.library().listing().refusal == "no world is open");
  const bool has_library = GENERATE(false, true);
  server.features = has_library ? kFeatureBuilds : 0;
  open();
  CHECK(session.has_library() == has_library);
  session.library().list({});
  session.step_library(now);
  const auto asked = take<BuildsRequest>(sent());
  if (!has_library) {
    CHECK(asked.empty());
    CHECK(session.library().listing().refusal == "this server gives clients no library of builds");
    return;
  }
  REQUIRE(asked.size() == 1);
  receive(Builds{asked[0].request, {listed_build(3)}, false, 1, {}});
  CHECK(session.library().listing().builds.size() == 1);
  session.library().fetch(3);
  session.step_library(now);
  CHECK(take<BuildPieceRequest>(sent()).size() == 1);
  session.disconnected();
  CHECK(session.library().fetched().refusal == "the connection ended");
  CHECK(session.library().listing().builds.size() == 1);  // the same world may come back
}

}  // namespace runstone::test::session_bench
