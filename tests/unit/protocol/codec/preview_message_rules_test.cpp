// Which values are refused of shared previews.
#include "tests/unit/protocol/codec/built_message.hpp"

namespace runstone::test {
namespace {

const EditDescriptor kPreviewed{SetVoxel{{1, 2, 3}}, {}, 1};

Bytes with_length(const Bytes& descriptor) {
  Bytes out = varints({descriptor.size()});
  return joined(std::move(out), descriptor);
}

Bytes list_of(std::size_t count) {
  Bytes out;
  for (std::size_t i = 0; i < count; ++i)
    out = joined(std::move(out), with_length(encode(kPreviewed)));
  return out;
}

bool passes_list(const Bytes& list) {
  return passes<PreviewShare>(
      [&](FlatBufferBuilder& b) { return wire::CreatePreviewShare(b, b.CreateVector(list)); });
}

}  // namespace

TEST_CASE("a preview has up to four whole valid edits, and nothing behind them", "[protocol]") {
  CHECK(passes<PreviewShare>([](FlatBufferBuilder& b) { return wire::CreatePreviewShare(b); }));
  for (std::size_t count = 0; count <= kPreviewEditsMax; ++count)
    CHECK(passes_list(list_of(count)));
  CHECK_FALSE(passes_list(list_of(kPreviewEditsMax + 1)));
  const Bytes one = list_of(1);
  for (std::size_t size = 1; size < one.size(); ++size)
    CHECK_FALSE(passes_list({one.begin(), one.begin() + static_cast<std::ptrdiff_t>(size)}));
  CHECK_FALSE(passes_list(joined(one, {0})));
  CHECK_FALSE(passes_list(joined(one, {9})));
  CHECK_FALSE(passes_list(varints({kPreviewBytesMax + 1})));
  CHECK_FALSE(passes_list(Bytes(kPreviewBytesMax + 2 * kPreviewEditsMax + 1, std::uint8_t{0})));
  CHECK_FALSE(passes_list(with_length({99})));  // of an unknown kind
}

TEST_CASE("edits are shared if they are few, valid and near to each other", "[protocol]") {
  const std::vector<EditDescriptor> none;
  CHECK(may_be_shared(none, 16));
  CHECK(may_be_shared({kPreviewed, kPreviewed, kPreviewed, kPreviewed}, 16));
  CHECK_FALSE(may_be_shared(std::vector<EditDescriptor>(5, kPreviewed), 16));
  const EditDescriptor ball{FillSphere{{0, 0, 0}, 24}, {}, 1};
  CHECK(may_be_shared({ball}, 32));
  CHECK(may_be_shared({ball}, 16));
  CHECK_FALSE(may_be_shared({{FillSphere{{0, 0, 0}, 64}, {}, 1}}, 16));
  FillStroke stroke{{}, 2};
  for (std::int32_t i = 0; i < 200; ++i) stroke.points.push_back({i % 2 * 900, i % 3 * 900, i});
  CHECK_FALSE(may_be_shared({{stroke, {}, 1}}, 128));
  CHECK_FALSE(may_be_shared({{Paste{}, {}, kEmpty}}, 16));  // without a clipboard
}

}  // namespace runstone::test
