#include "tests/unit/protocol/codec/built_message.hpp"

#include <optional>
#include <string>
#include <vector>

namespace runstone::test {
namespace {

const EditDescriptor kValidEdit{SetVoxel{{1, 2, 3}}, {}, 1};

/// One edit of a commit, field by field as docs/protocol.md lists them.
struct EditFields {
  std::uint64_t seq = 10;        // relative to the edit before
  std::int64_t ordered_us = 50;  // relative to the edit before
  std::uint64_t author = 1, instance = 1, client_seq = 1;
  std::uint8_t cause = 0;
  std::uint64_t subject = 0;
  std::int64_t delay_us = 20;  // from click to order
  Bytes edit = encode(kValidEdit);
  std::optional<std::uint64_t> edit_bytes;  // if it differs from the size of the edit
  std::uint64_t count = 1;                  // of touched chunks
  Bytes previous{1};
  void put(ByteWriter& out) const {
    out.varint(seq);
    out.svarint(ordered_us);
    out.varint(author);
    out.u64(instance);
    out.varint(client_seq);
    out.u8(cause);
    out.varint(subject);
    out.svarint(delay_us);
    out.varint(edit_bytes.value_or(edit.size()));
    out.bytes(edit);
    out.varint(count);
    out.bytes(previous);
  }
};

struct CommitFields {
  std::uint32_t epoch = 1;
  EditFields edit;
  std::size_t edits = 1;
  Bytes behind;
  Bytes list() const {
    Bytes bytes;
    ByteWriter out(bytes);
    for (std::size_t i = 0; i < edits; ++i) edit.put(out);
    out.bytes(behind);
    return bytes;
  }
  Offset<wire::Commit> operator()(FlatBufferBuilder& b) const {
    return wire::CreateCommit(b, epoch, b.CreateVector(list()));
  }
};

/// Returns a commit of these list bytes.
auto commit_of(const Bytes& list) {
  return [&list](FlatBufferBuilder& b) { return wire::CreateCommit(b, 1, b.CreateVector(list)); };
}

}  // namespace

TEST_CASE(
    "an edit request with an invalid descriptor decodes to a fault, and one without a sequence is "
    "refused",
    "[protocol]") {
  const auto request = [](std::uint64_t seq, const Bytes& edit, TimeUs submitted_us = 0) {
    return received<EditRequest>([&](auto& b) {
      return wire::CreateEditRequest(b, seq, submitted_us, b.CreateVector(edit));
    });
  };
  const Bytes edit = encode(kValidEdit);
  REQUIRE(request(1, edit).has_value());
  CHECK(*request(1, edit) == Message(EditRequest{1, 0, kValidEdit}));
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
  const auto max = static_cast<std::int64_t>(kWireTimeUsMax);
  refuses<Commit, CommitFields>({
      [](auto& c) { c.epoch = 0; },
      [](auto& c) { c.edit.seq = 0; },
      [](auto& c) { c.edit.seq = kSequenceMax + 1; },
      [](auto& c) { c.edit.seq = ~0ULL; },
      [](auto& c) { c.edits = 0; },
      [](auto& c) { c.behind = {0}; },
      [](auto& c) { c.edit.author = 1ULL << 32; },
      [](auto& c) { c.edit.cause = kCauseMax + 1; },
      [](auto& c) { c.edit.cause = static_cast<std::uint8_t>(Cause::rights); },
      [](auto& c) { c.edit.cause = static_cast<std::uint8_t>(Cause::materials); },
      [](auto& c) { c.edit.subject = 10; },  // its own subject
      [=](auto& c) { c.edit.ordered_us = max + 1; },
      [=](auto& c) { c.edit.ordered_us = -max - 1; },
      [](auto& c) { c.edit.ordered_us = INT64_MIN; },
      [=](auto& c) { c.edit.delay_us = max + 51; },  // clicked before the lowest time
      [=](auto& c) { c.edit.delay_us = 49 - max; },  // clicked after the highest time
      [](auto& c) { c.edit.delay_us = INT64_MIN; },
      [](auto& c) { c.edit.edit.pop_back(); },
      [](auto& c) { c.edit.edit_bytes = 1'000; },  // more than there are
      [](auto& c) { c.edit.edit_bytes = kDescriptorBytesMax + 1; },
      [](auto& c) { c.edit.edit_bytes = 0; },
      [](auto& c) { c.edit.previous = {0}; },           // its own predecessor
      [](auto& c) { c.edit.previous = {11}; },          // before the log
      [](auto& c) { c.edit.previous = {0x81, 0x00}; },  // varint is not canonical
      [](auto& c) { c.edit.previous = {0x81}; },        // varint is truncated
  });
  CommitFields edges;
  edges.edit.previous = {10};  // the base
  edges.edit.subject = 9;
  edges.edit.ordered_us = max;
  edges.edit.delay_us = 2 * max;
  const auto decoded = received<Commit>(edges);
  REQUIRE(decoded.has_value());
  const OrderedEdit& edit = std::get<Commit>(*decoded).edits[0];
  CHECK(edit.previous == std::vector<Sequence>{0});
  CHECK(edit.subject == 9);
  CHECK(edit.ordered_us == max);
  CHECK(edit.submitted_us == -max);
}

TEST_CASE("the times of a commit stay in range although they are sums", "[protocol]") {
  CommitFields two;
  two.edits = 2;
  two.edit.ordered_us = kWireTimeUsMax / 2;
  CHECK(passes<Commit>(two));
  two.edit.ordered_us = kWireTimeUsMax / 2 + 1;
  CHECK_FALSE(passes<Commit>(two));
}

TEST_CASE("a commit counts the chunks that each edit touches", "[protocol]") {
  CommitFields fields;
  fields.edit.edit = encode({FillBox{{{10, 0, 0}, {20, 1, 1}}}, {}, 1});  // two chunks of edge 16
  const auto counting = [&fields](std::uint64_t count, std::size_t listed, std::uint16_t edge) {
    fields.edit.count = count;
    fields.edit.previous = Bytes(listed, 1);
    return received<Commit>(fields, edge);
  };
  const auto right = counting(2, 2, kMessageEdge);
  REQUIRE(right.has_value());
  CHECK(std::get<Commit>(*right).edits[0].previous == std::vector<Sequence>{9, 9});
  for (const std::uint64_t count : {0u, 1u, 3u}) {
    CAPTURE(count);
    const auto wrong = counting(count, count, kMessageEdge);
    REQUIRE_FALSE(wrong.has_value());
    CHECK(wrong.error().code == ErrorCode::bad_value);
    // A reader that does not know the edge, or the geometry of the edit, reads the list all the
    // same.
    const auto without_edge = counting(count, count, 0);
    REQUIRE(without_edge.has_value());
    CHECK(std::get<Commit>(*without_edge).edits[0].previous.size() == count);
  }
  for (const std::uint16_t edge : {std::uint16_t{0}, kMessageEdge}) {
    CAPTURE(edge);
    CHECK_FALSE(counting(2, 1, edge).has_value());  // the list ends before its count
    CHECK_FALSE(counting(2, 3, edge).has_value());  // one byte is left over
    CHECK_FALSE(counting(kTouchedChunksMax + 1, kTouchedChunksMax + 1, edge).has_value());
    CHECK_FALSE(counting(~0ULL, 2, edge).has_value());
  }
  CHECK(counting(kTouchedChunksMax, kTouchedChunksMax, 0).has_value());
}

TEST_CASE("an edit that touches millions of chunks is refused before they are listed",
          "[protocol]") {
  CommitFields fields;
  fields.edit.edit = encode({FillBox{{{0, 0, 0}, {4096, 4096, 4096}}}, {}, 1});
  const auto decoded = received<Commit>(fields);
  REQUIRE_FALSE(decoded.has_value());
  CHECK(decoded.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("a commit has at most 4,096 edits", "[protocol]") {
  CommitFields fields;
  fields.edits = kCommitEditsMax;
  CHECK(passes<Commit>(fields));
  fields.edits = kCommitEditsMax + 1;
  CHECK_FALSE(passes<Commit>(fields));
}

TEST_CASE("a truncated list of edits holds the whole edits before its end, or is refused",
          "[protocol]") {
  CommitFields fields;
  fields.edits = 3;
  fields.edit.edit = encode({FillBox{{{10, 0, 0}, {20, 1, 1}}}, {}, 1});
  fields.edit.count = 2;
  fields.edit.previous = {10, 1};
  const Bytes list = fields.list();
  const std::size_t edit_bytes = list.size() / 3;
  for (const std::uint16_t edge : {std::uint16_t{0}, kMessageEdge}) {
    for (std::size_t size = 0; size <= list.size(); ++size) {
      CAPTURE(edge, size);
      const Bytes cut(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(size));
      const auto decoded = received<Commit>(commit_of(cut), edge);
      REQUIRE(decoded.has_value() == (size != 0 && size % edit_bytes == 0));
      if (decoded) CHECK(std::get<Commit>(*decoded).edits.size() == size / edit_bytes);
    }
  }
}

TEST_CASE("a commit without a list is refused", "[protocol]") {
  CHECK_FALSE(passes<Commit>([](auto& b) { return wire::CreateCommit(b, 1); }));
}

TEST_CASE("an action of a request begins with this edit or an earlier one", "[protocol]") {
  const auto with_action = [](std::uint64_t action) {
    return [action](FlatBufferBuilder& b) {
      const Bytes edit = encode(kValidEdit);
      return wire::CreateEditRequest(b, 7, 0, b.CreateVector(edit), action);
    };
  };
  for (const std::uint64_t action : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{7}}) {
    const auto message = received<EditRequest>(with_action(action));
    REQUIRE(message.has_value());
    CHECK(std::get<EditRequest>(*message).action == action);
  }
  CHECK_FALSE(passes<EditRequest>(with_action(8)));
}

}  // namespace runstone::test
