#include "common/edits/clipboard/clipboard.hpp"

#include <catch2/catch.hpp>

#include "common/edits/clipboard/clipboard_builder.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/edits/edit_oracle.hpp"

namespace runstone::test {
namespace {

RunChunk cells_of(Extent extent, const std::vector<Run>& runs, AxisOrder order = AxisOrder::xyz) {
  RunChunk cells{extent, order, RunList(extent.volume())};
  for (const Run& run : runs) cells.runs.push_back(run);
  return cells;
}

ErrorCode error_of(std::vector<Material> palette, const RunChunk& cells) {
  const auto clipboard = Clipboard::of(std::move(palette), cells);
  REQUIRE_FALSE(clipboard.has_value());
  return clipboard.error().code;
}

std::shared_ptr<const Clipboard> read_back(const Bytes& bytes, Result<void>& end) {
  ByteReader r(bytes);
  auto clipboard = read_clipboard(r);
  end = r.finish();
  return clipboard;
}

ErrorCode read_error(const Bytes& bytes) {
  Result<void> end;
  const auto clipboard = read_back(bytes, end);
  REQUIRE(clipboard == nullptr);
  REQUIRE_FALSE(end.has_value());
  return end.error().code;
}

Bytes bytes_of(const Clipboard& clipboard) {
  Bytes bytes;
  ByteWriter w(bytes);
  write_clipboard(w, clipboard);
  return bytes;
}

// Makes `count` runs of one cell each, then one run of untouched cells.
Result<std::shared_ptr<const Clipboard>> alternating(std::uint32_t count) {
  std::vector<Run> runs;
  for (std::uint32_t i = 0; i < count; ++i)
    runs.push_back({i + 1, static_cast<Material>(1 + i % 2)});
  const Extent extent{128, 128, 4};
  runs.push_back({extent.volume(), 0});
  return Clipboard::of({1, 2}, cells_of(extent, runs));
}

}  // namespace

TEST_CASE("a clipboard's first broken invariant is named", "[edits]") {
  const Extent line{6, 1, 1};
  CHECK(Clipboard::of({0, 7}, cells_of(line, {{2, 0}, {3, 1}, {6, 2}})).has_value());
  CHECK(error_of({}, cells_of(line, {{6, 0}})) == ErrorCode::bad_value);       // no cell is touched
  CHECK(error_of({7}, cells_of(line, {{6, 0}})) == ErrorCode::not_canonical);  // no cell is touched
  CHECK(error_of({0, 7}, cells_of(line, {{6, 1}})) == ErrorCode::not_canonical);  // 7 is unused
  CHECK(error_of({7, 0}, cells_of(line, {{2, 1}, {6, 2}})) == ErrorCode::not_canonical);
  CHECK(error_of({7, 7}, cells_of(line, {{2, 1}, {6, 2}})) == ErrorCode::not_canonical);
  CHECK(error_of({7}, cells_of(line, {{2, 1}, {6, 2}})) == ErrorCode::bad_value);
  CHECK(error_of({7}, cells_of(line, {{2, 1}, {6, 1}})) == ErrorCode::broken_invariant);
  CHECK(error_of({7}, cells_of(line, {{5, 1}})) == ErrorCode::broken_invariant);
  CHECK(error_of({7}, cells_of({0, 1, 1}, {})) == ErrorCode::bad_value);
  CHECK(error_of({7}, cells_of({129, 1, 1}, {{129, 1}})) == ErrorCode::bad_value);
}

TEST_CASE("a builder takes cells in any axis order and keeps the one with the fewest runs",
          "[edits]") {
  // Along y: untouched, empty, 9 in all lines. Three runs with y slowest.
  for (const AxisOrder order : kAxisOrders) {
    const Extent extent{5, 3, 4};
    ClipboardBuilder builder(extent, order);
    for (std::uint32_t i = 0; i < extent.volume(); ++i) {
      const std::int32_t y = dense_pos(extent, order, i).y;
      builder.append(1, y == 0 ? std::nullopt : std::optional<Material>(y == 1 ? kEmpty : 9));
    }
    const auto made = builder.finish();
    REQUIRE(made.has_value());
    const Clipboard& clipboard = **made;
    CHECK(clipboard.cells() == cells_of(extent, {{20, 0}, {40, 1}, {60, 2}}, AxisOrder::xzy));
    CHECK(clipboard.palette() == std::vector<Material>{0, 9});
    CHECK(clipboard.touched() == 40);
    CHECK(clipboard.touched_box() == CellBox{{0, 1, 0}, {5, 2, 4}});
    CHECK(clipboard.at({2, 0, 3}) == std::nullopt);
    CHECK(clipboard.at({2, 1, 3}) == Material{0});
    CHECK(clipboard.at({2, 2, 3}) == Material{9});
  }
}

TEST_CASE("a builder rejects cells without a touched one and clipboards that are too long",
          "[edits]") {
  ClipboardBuilder nothing({2, 2, 2});
  nothing.append(8, std::nullopt);
  const auto empty = nothing.finish();
  REQUIRE_FALSE(empty.has_value());
  CHECK(empty.error().code == ErrorCode::bad_value);

  // Random cells in the largest extent: too long in each axis order.
  SplitMix64 rng{42};
  ClipboardBuilder noise({64, 64, 16});
  for (std::uint32_t i = 0; i < 65536; ++i) noise.append(1, static_cast<Material>(rng.below(20)));
  const auto noisy = noise.finish();
  REQUIRE_FALSE(noisy.has_value());
  CHECK(noisy.error().code == ErrorCode::limit_exceeded);

  ClipboardBuilder colourful({128, 128, 4});
  for (std::uint32_t i = 0; i < 65536; ++i) colourful.append(1, static_cast<Material>(i));
  const auto colours = colourful.finish();
  REQUIRE_FALSE(colours.has_value());
  CHECK(colours.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("a clipboard may have as many bytes as the limit, and no more", "[edits]") {
  // 7 bytes for order, sides and palette, one byte for each short run, three for the long last one.
  const auto longest = alternating(kClipboardBytesMax - 10);
  REQUIRE(longest.has_value());
  CHECK((*longest)->byte_size() == kClipboardBytesMax);
  CHECK(bytes_of(**longest).size() == kClipboardBytesMax);
  const EditDescriptor edit = {
      Paste{{0, 0, 0}, *longest, {}}, {MaskKind::only_material, 65535}, kEmpty};
  const Bytes descriptor = encode(edit);
  CHECK(descriptor.size() <= descriptor_bytes_max(EditKind::paste));
  const auto back = decode_descriptor(descriptor);
  REQUIRE(back.has_value());
  CHECK(*back == edit);
  const auto longer = alternating(kClipboardBytesMax - 9);
  REQUIRE_FALSE(longer.has_value());
  CHECK(longer.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("only the canonical bytes of a clipboard are read", "[edits]") {
  const Bytes good = {0, 2, 0, 1, 1, 0, 6, 5, 2, 0, 1};  // as in docs/edit-log.md
  Result<void> end;
  const auto clipboard = read_back(good, end);
  REQUIRE(clipboard != nullptr);
  REQUIRE(end.has_value());
  CHECK(bytes_of(*clipboard) == good);
  const auto with = [&good](std::size_t at, Bytes instead, std::size_t count = 1) {
    Bytes bytes = good;
    const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    bytes.erase(from, from + static_cast<std::ptrdiff_t>(count));
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), instead.begin(), instead.end());
    return bytes;
  };
  CHECK(read_error(with(0, {6})) == ErrorCode::bad_value);    // axis order
  CHECK(read_error(with(1, {128})) == ErrorCode::bad_value);  // side
  CHECK(read_error(with(4, {2})) == ErrorCode::truncated);    // one material more than announced
  CHECK(read_error(with(4, {0x80, 0x80, 0x04})) == ErrorCode::bad_value);  // more than possible
  CHECK(read_error(with(4, {10})) == ErrorCode::truncated);  // more than the remaining bytes
  CHECK(read_error(with(5, {0xff, 0xff, 0x03})) ==
        ErrorCode::bad_value);                               // a material beyond 65,535
  CHECK(read_error(with(10, {3})) == ErrorCode::bad_value);  // a run behind the end
  Bytes unused = {0, 0, 0, 0, 1, 0, 6, 2};                   // one cell of 7, a palette of 0 and 7
  CHECK(read_error(unused) == ErrorCode::not_canonical);
  CHECK(read_error({0, 0, 0, 0, 0, 7, 0}) == ErrorCode::not_canonical);  // only untouched cells
  for (std::size_t size = 0; size < good.size(); ++size) {
    CHECK(read_error(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size))) ==
          ErrorCode::truncated);
  }
  CHECK(read_error(Bytes(kClipboardBytesMax + 1, 0)) == ErrorCode::limit_exceeded);
}

TEST_CASE(
    "random clipboards round trip, and flipped bytes are rejected or decode to their own encoding",
    "[edits]") {
  SplitMix64 rng{41};
  std::size_t survivors = 0;
  for (int round = 0; round < 300; ++round) {
    const auto clipboard = random_clipboard(rng, 20, rng.below(4) == 0 ? 65536 : 6);
    const Bytes bytes = bytes_of(*clipboard);
    REQUIRE(clipboard->byte_size() == bytes.size());
    Result<void> end;
    const auto back = read_back(bytes, end);
    REQUIRE(back != nullptr);
    REQUIRE(*back == *clipboard);
    REQUIRE(back->touched() == clipboard->touched());
    for (int flip = 0; flip < 50; ++flip) {
      Bytes flipped = bytes;
      const auto at = rng.below(static_cast<std::uint32_t>(bytes.size()));
      flipped[at] = static_cast<std::uint8_t>(flipped[at] ^ (1u << rng.below(8)));
      const auto other = read_back(flipped, end);
      if (other == nullptr || !end) continue;
      ++survivors;
      REQUIRE(bytes_of(*other) == flipped);
    }
  }
  CHECK(survivors > 1000);
}

}  // namespace runstone::test
