#include "tests/unit/protocol/codec/built_message.hpp"

#include <string>
#include <vector>

namespace runstone::test {
namespace {

const EditDescriptor kEdit{SetVoxel{{1, 2, 3}}, {}, 1};

struct CommitFields {
  std::uint32_t epoch = 1;
  std::uint64_t first = 10;
  std::uint8_t cause = 0;
  Bytes edit = encode(kEdit);
  Bytes previous{1};
  std::size_t edits = 1;
  std::uint64_t subject = 0;
  bool shared = false;  // all edits point at one list
  Offset<wire::Commit> operator()(FlatBufferBuilder& b) const {
    std::vector<Offset<wire::OrderedEdit>> list;
    Vector list_of_all;
    if (shared) list_of_all = b.CreateVector(previous);
    for (std::size_t i = 0; i < edits; ++i) {
      const auto e = b.CreateVector(edit);
      const auto p = shared ? list_of_all : b.CreateVector(previous);
      list.push_back(wire::CreateOrderedEdit(b, 1, 1, 1, cause, 0, 0, e, p, subject));
    }
    return wire::CreateCommit(b, epoch, first, b.CreateVector(list));
  }
};

}  // namespace

TEST_CASE(
    "an edit request with an invalid descriptor decodes to a fault; one without a sequence is "
    "refused",
    "[protocol]") {
  const auto request = [](std::uint64_t seq, const Bytes& edit, TimeUs submitted_us = 0) {
    return received(Sender::client, FrameClass::edits, [&](auto& b) {
      return wire::CreateEditRequest(b, seq, submitted_us, b.CreateVector(edit));
    });
  };
  const Bytes edit = encode(kEdit);
  REQUIRE(request(1, edit).has_value());
  CHECK(*request(1, edit) == Message(EditRequest{1, 0, kEdit}));
  CHECK(request(kSequenceMax, edit).has_value());
  CHECK_FALSE(request(kSequenceMax + 1, edit).has_value());  // the store has 63 bits
  CHECK_FALSE(request(0, edit).has_value());
  CHECK_FALSE(request(1, edit, kWireTimeUsMax + 1).has_value());

  Bytes longer = edit;
  longer.push_back(0);
  Bytes unknown_kind = edit;
  unknown_kind[0] = 0xff;
  for (const Bytes& bytes :
       {Bytes{}, Bytes(edit.begin(), edit.end() - 1), longer, unknown_kind, Bytes(60'000, 0xff)}) {
    CAPTURE(bytes.size());
    const auto decoded = request(1, bytes);
    REQUIRE(decoded.has_value());
    const auto& bad = std::get<EditRequest>(*decoded);
    CHECK(bad.client_seq == 1);
    REQUIRE(bad.fault.has_value());
    CHECK(std::string(bad.fault->what) != "");
    CHECK(request(0, bytes).has_value() == false);
  }
}

TEST_CASE("a commit is refused if its fields contradict each other", "[protocol]") {
  const Bytes large_box = encode({FillBox{{{0, 0, 0}, {4096, 4096, 4096}}}, {}, 1});
  refuses<CommitFields>(
      Sender::server, FrameClass::edits,
      {[](auto& c) { c.epoch = 0; }, [](auto& c) { c.first = 0; }, [](auto& c) { c.first = ~0ULL; },
       [](auto& c) { c.edits = 0; }, [](auto& c) { c.edits = kCommitEditsMax + 1; },
       [](auto& c) { c.cause = kCauseMax + 1; }, [](auto& c) { c.edit.pop_back(); },
       [](auto& c) { c.subject = 10; },             // its own subject
       [](auto& c) { c.previous = {0}; },           // its own predecessor
       [](auto& c) { c.previous = {11}; },          // before the log
       [](auto& c) { c.previous = {}; },            // touches one chunk, lists none
       [](auto& c) { c.previous = {1, 1}; },        // touches one chunk, lists two
       [](auto& c) { c.previous = {0x81, 0x00}; },  // varint is not canonical
       [](auto& c) { c.previous = {0x81}; },        // varint is truncated
       [&](auto& c) { c.edit = large_box; },        // touches 2^24 chunks
       [](auto& c) { c.previous = Bytes(kTouchedChunksMax + 1, 1), c.first = 10; },
       [](auto& c) { c.edits = 2000, c.shared = true, c.previous = Bytes(4000, 1); }});
  CommitFields from_base;
  from_base.previous = {10};
  from_base.subject = 9;
  const auto decoded = received(Sender::server, FrameClass::edits, from_base);
  REQUIRE(decoded.has_value());
  CHECK(std::get<Commit>(*decoded).edits[0].previous == std::vector<Sequence>{0});
  CHECK(std::get<Commit>(*decoded).edits[0].subject == 9);
}

TEST_CASE("previous sequences that edits share are refused if they outgrow the message",
          "[protocol]") {
  // 128 KB on the wire would become 64 MB of sequences.
  CommitFields shared;
  shared.edits = 2000;
  shared.shared = true;
  shared.previous = Bytes(4000, 1);
  const auto decoded = received(Sender::server, FrameClass::edits, shared, 0);
  REQUIRE_FALSE(decoded.has_value());
  CHECK(decoded.error().what == std::string("commit shares its lists of previous sequences"));
}

}  // namespace runstone::test
