// Rules of the entries of Chunks, and of the messages about history.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/runs/run_builder.hpp"
#include "tests/support/core/count_allocations.hpp"
#include "tests/unit/protocol/codec/built_message.hpp"

namespace runstone::test {
namespace {

const EditDescriptor kEdit{SetVoxel{{1, 2, 3}}, {}, 1};

/// What the entries of both forms begin with, field by field as docs/protocol.md lists them.
struct EntryHead {
  std::uint8_t form = 0;
  std::array<std::int64_t, 3> key{1, 2, 3};
  Bytes version{1, 12};
  std::array<std::uint64_t, 2> digest{5, 6};
  void put(ByteWriter& out) const {
    for (const std::int64_t c : key) out.svarint(c);
    out.u8(form);
    out.bytes(version);
    for (const std::uint64_t lane : digest) out.u64(lane);
  }
};

struct SnapshotFields {
  EntryHead head;
  Bytes data = encode_chunk(uniform_chunk(Extent::cube(kMessageEdge), 1), ChunkEncoding::raw);
  std::optional<std::uint64_t> data_bytes;  // if it differs from the size of the data
  Bytes behind;
  Bytes bytes() const {
    Bytes bytes;
    ByteWriter out(bytes);
    head.put(out);
    out.varint(data_bytes.value_or(data.size()));
    out.bytes(data);
    out.bytes(behind);
    return bytes;
  }
  Offset<wire::Chunks> operator()(FlatBufferBuilder& b) const {
    return wire::CreateChunks(b, 1, b.CreateVector(bytes()));
  }
};

struct ChunkEditsFields {
  ChunkEditsFields() { head.form = 1; }
  EntryHead head;
  std::uint64_t back = 3;  // from sequence 9 to 12
  struct Edit {
    std::uint64_t step;
    Bytes edit;
    std::optional<std::uint64_t> edit_bytes;
  };
  std::vector<Edit> edits = {{1, encode(kEdit), {}}, {2, encode(kEdit), {}}};
  std::int64_t list_bytes_more = 0;
  Bytes bytes() const {
    Bytes list;
    ByteWriter edit_out(list);
    for (const Edit& e : edits) {
      edit_out.varint(e.step);
      edit_out.varint(e.edit_bytes.value_or(e.edit.size()));
      edit_out.bytes(e.edit);
    }
    Bytes bytes;
    ByteWriter out(bytes);
    head.put(out);
    out.varint(back);
    out.varint(list.size() + static_cast<std::uint64_t>(list_bytes_more));
    out.bytes(list);
    return bytes;
  }
  Offset<wire::Chunks> operator()(FlatBufferBuilder& b) const {
    return wire::CreateChunks(b, 1, b.CreateVector(bytes()));
  }
};

Result<Message> read_list(const Bytes& list, std::uint16_t edge = kMessageEdge) {
  return received<Chunks>([&](auto& b) { return wire::CreateChunks(b, 1, b.CreateVector(list)); },
                          edge);
}

/// Returns a chunk of the largest number of runs: no two neighbours are equal.
RunChunk striped_chunk(unsigned edge) {
  RunBuilder builder(Extent::cube(edge), AxisOrder::xyz);
  for (std::uint32_t i = 0; i < Extent::cube(edge).volume(); ++i)
    builder.append(1, static_cast<Material>(1 + i % 2));
  return builder.finish();
}

}  // namespace

TEST_CASE("a snapshot is refused with a bad form, version, digest, bytes or size", "[protocol]") {
  refuses<Chunks, SnapshotFields>(
      {[](auto& c) { c.head.form = 2; }, [](auto& c) { c.head.form = 255; },
       [](auto& c) { c.head.form = 1; },  // the bytes are a snapshot
       [](auto& c) { c.head.version = {0, 12}; }, [](auto& c) { c.head.version = {1, 0}; },
       [](auto& c) { c.head.digest[0] = (1ULL << 61) - 1; },
       [](auto& c) { c.head.digest[1] = ~0ULL; }, [](auto& c) { c.data.clear(); },
       [](auto& c) { c.data.pop_back(); }, [](auto& c) { c.data.push_back(0); },
       [](auto& c) { c.data_bytes = c.data.size() - 1; },
       [](auto& c) { c.data_bytes = c.data.size() + 1; },  // past the end
       [](auto& c) { c.data_bytes = ~0ULL; }, [](auto& c) { c.behind = {0}; },
       [](auto& c) {
         c.data = encode_chunk(uniform_chunk(Extent::cube(32), 1), ChunkEncoding::raw);
       }});
  SnapshotFields base;
  base.head.version = {0};
  CHECK(passes<Chunks>(base));
  // Before Welcome the chunk edge is unknown.
  base.data = encode_chunk(uniform_chunk(Extent{8, 9, 10}, 1), ChunkEncoding::packed);
  CHECK(passes<Chunks>(base, 0));
  CHECK_FALSE(passes<Chunks>(base));
}

TEST_CASE("chunk edits are refused unless they lead from one version to the other", "[protocol]") {
  refuses<Chunks, ChunkEditsFields>(
      {[](auto& f) { f.head.form = 2; }, [](auto& f) { f.head.form = 0; },  // the bytes are edits
       [](auto& f) { f.head.version = {0}; }, [](auto& f) { f.back = 0; },
       [](auto& f) { f.back = 2; }, [](auto& f) { f.back = 4; },
       [](auto& f) { f.back = 13; },  // before the log
       [](auto& f) { f.edits[1].step = 0; }, [](auto& f) { f.edits[0].step = 2; },
       [](auto& f) { f.edits[1].step = ~0ULL; }, [](auto& f) { f.edits.clear(); },
       [](auto& f) { f.edits[0].edit.push_back(0); }, [](auto& f) { f.edits[0].edit = {}; },
       [](auto& f) { f.edits[1].edit_bytes = 1'000; },
       [](auto& f) { f.edits[1].edit_bytes = kDescriptorBytesMax + 1; },
       [](auto& f) { f.list_bytes_more = 1; },  // past the end
       [](auto& f) { f.list_bytes_more = -1; }, [](auto& f) { f.list_bytes_more = -1'000; },
       [](auto& f) {
         f.head.version = joined({2}, varints({kChunkEditsMax + 1}));
         f.back = kChunkEditsMax + 1;
         f.edits.assign(kChunkEditsMax + 1, {1, encode(kEdit), {}});
       }});
  ChunkEditsFields most;
  most.head.version = joined({2}, varints({kChunkEditsMax}));
  most.back = kChunkEditsMax;
  most.edits.assign(kChunkEditsMax, {1, encode(kEdit), {}});
  const auto decoded = received<Chunks>(most);
  REQUIRE(decoded.has_value());
  const auto& edits = std::get<ChunkEdits>(std::get<Chunks>(*decoded).chunks[0]);
  CHECK(edits.from == 0);
  CHECK(edits.to == Version{2, kChunkEditsMax});
  CHECK(edits.edits.size() == kChunkEditsMax);
}

TEST_CASE("a truncated list of chunks holds the whole entries before its end, or is refused",
          "[protocol]") {
  const Bytes snapshot = SnapshotFields{}.bytes();
  const Bytes edits = ChunkEditsFields{}.bytes();
  const Bytes list = joined(joined(snapshot, edits), snapshot);
  const auto whole = read_list(list);
  REQUIRE(whole.has_value());
  const auto& chunks = std::get<Chunks>(*whole).chunks;
  REQUIRE(chunks.size() == 3);
  CHECK(std::holds_alternative<ChunkSnapshot>(chunks[0]));
  CHECK(std::holds_alternative<ChunkEdits>(chunks[1]));
  CHECK(key_of(chunks[2]) == ChunkKey{0, {3, 6, 9}});
  for (std::size_t size = 0; size < list.size(); ++size) {
    CAPTURE(size);
    const auto cut =
        read_list(Bytes(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(size)));
    const bool is_between = size == snapshot.size() || size == snapshot.size() + edits.size();
    REQUIRE(cut.has_value() == is_between);
    if (cut) CHECK(std::get<Chunks>(*cut).chunks.size() == (size == snapshot.size() ? 1 : 2));
  }
}

TEST_CASE("several chunks of a message have 65,536 runs together at most", "[protocol]") {
  SnapshotFields stripes;  // 4,096 runs each
  stripes.data = encode_chunk(striped_chunk(kMessageEdge), ChunkEncoding::packed);
  const Bytes entry = stripes.bytes();
  Bytes list;
  for (int i = 0; i < 16; ++i) list = joined(list, entry);
  CHECK(read_list(list).has_value());
  const auto one_more = read_list(joined(list, entry));
  REQUIRE_FALSE(one_more.has_value());
  CHECK(one_more.error().code == ErrorCode::limit_exceeded);
  // Edits unpack to no runs.
  CHECK(read_list(joined(list, ChunkEditsFields{}.bytes())).has_value());
  const SnapshotFields uniform;
  CHECK_FALSE(read_list(joined(list, uniform.bytes())).has_value());
}

TEST_CASE("a chunk alone in its message may have more runs", "[protocol]") {
  SnapshotFields large;
  large.data = encode_chunk(striped_chunk(64), ChunkEncoding::packed);
  constexpr std::uint16_t kEdge = 64;
  CHECK(read_list(large.bytes(), kEdge).has_value());
  CHECK_FALSE(read_list(joined(large.bytes(), ChunkEditsFields{}.bytes()), kEdge).has_value());
  CHECK_FALSE(read_list(joined(ChunkEditsFields{}.bytes(), large.bytes()), kEdge).has_value());
}

TEST_CASE("a few bytes that stand for many runs do not fill the memory", "[protocol]") {
  SnapshotFields stripes;
  stripes.data = encode_chunk(striped_chunk(kMessageEdge), ChunkEncoding::packed);
  const Bytes entry = stripes.bytes();
  Bytes list;
  for (std::size_t i = 0; i < kChunksPerMessageMax; ++i) list = joined(list, entry);
  REQUIRE(list.size() < 32'768);
  static_cast<void>(read_list(entry));  // fills the scratch of the thread
  const Allocations cost = allocations_of([&] { REQUIRE_FALSE(read_list(list).has_value()); });
  // All 256 chunks would be a million runs of 4 bytes.
  CHECK(cost.bytes < 1'000'000);
}

TEST_CASE("a history request is refused with a field that its target does not use", "[protocol]") {
  const auto request = [](std::uint32_t number, std::uint8_t to, Sequence seq, TimeUs utc_us) {
    return passes<HistoryRequest>(
        [=](auto& b) { return wire::CreateHistoryRequest(b, number, to, seq, utc_us); });
  };
  CHECK(request(1, 0, 0, 0));
  CHECK(request(1, 1, kSequenceMax, 0));
  CHECK(request(1, 2, 0, -kWireTimeUsMax));
  CHECK_FALSE(request(0, 0, 0, 0));
  CHECK_FALSE(request(1, 3, 0, 0));
  CHECK_FALSE(request(1, 0, 5, 0));
  CHECK_FALSE(request(1, 2, 5, 0));
  CHECK_FALSE(request(1, 1, 5, 5));
  CHECK_FALSE(request(1, 1, kSequenceMax + 1, 0));
  CHECK_FALSE(request(1, 2, 0, kWireTimeUsMax + 1));
}

TEST_CASE("a view state is refused outside its bounds", "[protocol]") {
  struct Fields {
    std::uint32_t request = 1, view = 1;
    std::uint8_t phase = 1;
    bool past = true;
    Sequence seq = 5;
    TimeUs utc_us = 7;
    std::string text;
    Offset<wire::ViewState> operator()(FlatBufferBuilder& b) const {
      return wire::CreateViewState(b, request, view, phase, past, seq, utc_us,
                                   b.CreateString(text));
    }
  };
  refuses<ViewState, Fields>(
      {[](auto& f) { f.phase = 0; }, [](auto& f) { f.phase = 4; },
       [](auto& f) { f.request = 0; },              // nobody asked for the past
       [](auto& f) { f.past = false; },             // the live world has no sequence
       [](auto& f) { f.past = false, f.seq = 0; },  // nor a time
       [](auto& f) { f.seq = 0; },                  // no time before the first edit
       [](auto& f) { f.seq = kSequenceMax + 1; }, [](auto& f) { f.utc_us = kWireTimeUsMax + 1; },
       [](auto& f) { f.utc_us = -kWireTimeUsMax - 1; },
       [](auto& f) { f.text = std::string(kTextBytesMax + 1, 'x'); },
       [](auto& f) { f.text = "a\nb"; },
       [](auto& f) { f.past = false, f.seq = 0, f.utc_us = 0, f.request = 0, f.phase = 3; }});
  const auto state = [](std::uint32_t request, std::uint32_t view, std::uint8_t phase, bool past,
                        Sequence seq, TimeUs utc_us) {
    return passes<ViewState>(
        [=](auto& b) { return wire::CreateViewState(b, request, view, phase, past, seq, utc_us); });
  };
  // past, seq and utc_us have the same meaning in every phase.
  for (std::uint8_t phase = 1; phase <= kViewPhaseMax; ++phase) {
    CAPTURE(phase);
    CHECK(state(1, 1, phase, true, kSequenceMax, kWireTimeUsMax));
    CHECK(state(1, 1, phase, true, 0, 0));
    CHECK(state(1, 1, phase, false, 0, 0));
    CHECK(state(1, 0, phase, true, 5, -7) == (phase != 2));  // without a view nothing is complete
  }
  CHECK(state(0, 1, 2, false, 0, 0));  // the live view is complete, and nobody asked for the past
  CHECK(state(0, 0, 1, false, 0, 0));
}

TEST_CASE("a digest that is not that of the voxels is noticed", "[protocol]") {
  ChunkSnapshot snapshot;
  snapshot.chunk.voxels = uniform_chunk(Extent::cube(kMessageEdge), 4);
  snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
  CHECK(digest_matches(snapshot));
  ++snapshot.chunk.digest.lane[1];
  CHECK_FALSE(digest_matches(snapshot));
}

}  // namespace runstone::test
