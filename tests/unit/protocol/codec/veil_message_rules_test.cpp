// Veiled commits and patches that break a rule are refused, and so is every cut of one.
#include <catch2/catch.hpp>
#include <optional>

#include "common/veil/veil.hpp"
#include "common/veil/veil_patch_bytes.hpp"
#include "protocol/codec/commit_encoder.hpp"
#include "tests/unit/protocol/codec/built_message.hpp"

namespace runstone::test {
namespace {

/// The bytes of a patch with one voxel, or with none.
Bytes patch_bytes(bool has_span = true) {
  VeilPatch patch{Extent::cube(kMessageEdge), kVeilOrder, {}};
  if (has_span) patch.spans.push_back({5, 1, 7});
  Bytes bytes;
  ByteWriter out(bytes);
  write_patch_bytes(patch, out);
  return bytes;
}

/// An entry of a veiled commit without an edit, behind the fields that a commit has, too.
struct VeiledEntryFields {
  Bytes touched = varints({0}), count = varints({1}), key = svarints({0, -1, 0});
  std::uint64_t back = 3;
  Bytes patch = patch_bytes(), behind;
  std::uint32_t epoch = 1;
  std::optional<std::uint64_t> patch_size;
  Offset<wire::VeiledCommit> operator()(FlatBufferBuilder& b) const {
    Bytes bytes;
    ByteWriter out(bytes);
    out.varint(500);  // sequence
    out.svarint(0);   // ordered
    out.varint(2);    // author
    out.u64(7);       // instance
    out.varint(9);    // client sequence
    out.u8(0);        // cause
    out.varint(0);    // subject
    out.svarint(0);   // delay
    out.varint(0);    // descriptor
    for (const Bytes* part : {&touched, &count, &key}) out.bytes(*part);
    out.varint(back);
    out.varint(patch_size.value_or(patch.size()));
    out.bytes(patch);
    out.bytes(behind);
    return wire::CreateVeiledCommit(b, epoch, b.CreateVector(bytes));
  }
};

struct VeilPatchesFields {
  std::uint32_t epoch = 1;
  std::uint64_t seq = 500, back = 0;
  Bytes key = svarints({0, -1, 0}), patch = patch_bytes(), behind;
  Offset<wire::VeilPatches> operator()(FlatBufferBuilder& b) const {
    Bytes bytes;
    ByteWriter out(bytes);
    out.bytes(key);
    out.varint(back);
    out.varint(patch.size());
    out.bytes(patch);
    out.bytes(behind);
    return wire::CreateVeilPatches(b, epoch, seq, b.CreateVector(bytes));
  }
};

}  // namespace

TEST_CASE("a veiled commit is refused with a patch that breaks a rule", "[protocol][veil]") {
  refuses<VeiledCommit, VeiledEntryFields>({
      [](auto& e) { e.epoch = 0; },
      [](auto& e) { e.touched = varints({1, 1}); },  // without an edit
      [](auto& e) { e.count = varints({kVeilPatchesMax + 1}); },
      [](auto& e) { e.count = varints({2}); },
      [](auto& e) { e.count = varints({0}); },  // bytes are left over
      [](auto& e) { e.key = svarints({1 << 29, 0, 0}); },
      [](auto& e) { e.back = 0; },  // it follows no edit
      [](auto& e) { e.back = 501; },
      [](auto& e) { e.patch = patch_bytes(false); },
      [](auto& e) { e.patch.pop_back(); },
      [](auto& e) { e.patch.push_back(0); },
      [](auto& e) { e.patch_size = 1ULL << 60; },
      [](auto& e) { e.behind = varints({0}); },
  });
  const VeiledEntryFields fields;
  CHECK_FALSE(passes<VeiledCommit>(fields, 0));  // before Welcome
  const auto without_patch = [](FlatBufferBuilder& b) {
    VeiledCommit commit{1, {{}}};
    commit.edits[0].ordered.seq = 5;
    const CommitEncoder encoder(commit);
    return wire::CreateVeiledCommit(b, 1, b.CreateVector(encoder.list(encoder.all())));
  };
  CHECK(passes<VeiledCommit>(without_patch));
}

TEST_CASE("patches of a veil are refused with a version or bytes that break a rule",
          "[protocol][veil]") {
  refuses<VeilPatches, VeilPatchesFields>({
      [](auto& p) { p.epoch = 0; },
      [](auto& p) { p.seq = 0; },
      [](auto& p) { p.seq = kSequenceMax + 1; },
      [](auto& p) { p.back = 501; },
      [](auto& p) { p.key = svarints({0, 0, -(1 << 29)}); },
      [](auto& p) { p.patch = patch_bytes(false); },
      [](auto& p) { p.behind = varints({0}); },
      [](auto& p) {
        p.behind = joined(svarints({0, 0, 0}), joined(varints({0, 4}), patch_bytes()));
      },
  });
  CHECK_FALSE(passes<VeilPatches>(VeilPatchesFields{}, 0));
  const auto empty = [](FlatBufferBuilder& b) {
    return wire::CreateVeilPatches(b, 1, 5, b.CreateVector(Bytes{}));
  };
  CHECK_FALSE(passes<VeilPatches>(empty));
}

TEST_CASE("bytes that read as a veiled commit are those that are written for it",
          "[protocol][veil]") {
  SplitMix64 rng{Catch::rngSeed()};
  int refused = 0;
  const auto check = [&](const Bytes& bytes) {
    const auto message = received<VeiledCommit>([&](FlatBufferBuilder& b) {
      return wire::CreateVeiledCommit(b, 1, b.CreateVector(bytes));
    });
    refused += message ? 0 : 1;
    if (!message) return;
    const CommitEncoder encoder(std::get<VeiledCommit>(*message));
    CHECK(encoder.list(encoder.all()) == bytes);
  };
  for (int round = 0; round < 20; ++round) {
    const Message message = random_message(rng, kKindOf<VeiledCommit>);
    const CommitEncoder encoder(std::get<VeiledCommit>(message));
    const Bytes list = encoder.list(encoder.all());
    const auto size = static_cast<std::uint32_t>(list.size());
    check(list);
    for (int i = 0; i < 40; ++i) {
      check(Bytes(list.begin(), list.begin() + rng.below(size)));
      Bytes flipped = list;
      flipped[rng.below(size)] ^= static_cast<std::uint8_t>(1U << rng.below(8));
      check(flipped);
    }
  }
  CHECK(refused > 100);
}

}  // namespace runstone::test
