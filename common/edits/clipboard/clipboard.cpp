#include "common/edits/clipboard/clipboard.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "common/core/assert.hpp"
#include "common/runs/span_boxes.hpp"

namespace runstone {
namespace {

// Cell numbers have the 16 bits of a material. A full palette would exceed the byte limit by far.
constexpr std::size_t kPaletteMax = kClipboardBytesMax;

// The sides and the axis order.
constexpr std::size_t kHeadBytes = 4;

// Calls put(value) for each varint behind the head.
template <class Put>
void for_each_varint(const std::vector<Material>& palette, const RunChunk& cells, Put&& put) {
  put(palette.size() - 1);
  put(palette.front());
  for (std::size_t i = 1; i < palette.size(); ++i) put(palette[i] - palette[i - 1] - 1U);
  cells.runs.visit([&](const auto& runs) {
    std::uint32_t begin = 0;
    // Neighbouring runs differ, so a number is encoded among the numbers that the previous run does
    // not have.
    std::uint64_t numbers = palette.size() + 1;
    std::uint32_t before = 0xffff;  // above all numbers
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::uint32_t number = runs.material(i);
      put((runs.end(i) - begin - 1) * numbers + (number > before ? number - 1 : number));
      numbers = palette.size();
      begin = runs.end(i);
      before = number;
    }
  });
}

std::size_t encoded_size(const std::vector<Material>& palette, const RunChunk& cells) {
  std::size_t bytes = kHeadBytes;
  for_each_varint(palette, cells, [&](std::uint64_t value) { bytes += varint_size(value); });
  return bytes;
}

Result<void> check_palette(const std::vector<Material>& palette) {
  if (palette.empty()) return fail(ErrorCode::bad_value, "clipboard has no material");
  if (palette.size() > kPaletteMax)
    return fail(ErrorCode::limit_exceeded, "clipboard has too many materials");
  const auto unordered = std::adjacent_find(palette.begin(), palette.end(), std::greater_equal<>{});
  if (unordered != palette.end()) {
    return fail(ErrorCode::not_canonical, "clipboard palette does not ascend",
                static_cast<std::uint64_t>(unordered - palette.begin()));
  }
  return {};
}

// Returns the number of touched cells.
Result<std::uint32_t> check_cells(const RunChunk& cells, std::size_t palette_size) {
  if (!cells.extent.valid_part())
    return fail(ErrorCode::bad_value, "clipboard side outside 1..128");
  if (auto runs = validate_runs(cells); !runs) return failure(runs.error());
  std::vector<bool> used(palette_size + 1, false);
  std::uint32_t touched = 0;
  const auto check_runs = [&](const auto& runs) -> Result<void> {
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::uint16_t number = runs.material(i);
      if (number > palette_size)
        return fail(ErrorCode::bad_value, "clipboard cell outside the palette", i);
      used[number] = true;
      if (number != 0) touched += runs.end(i) - begin;
      begin = runs.end(i);
    }
    return {};
  };
  if (auto runs = cells.runs.visit(check_runs); !runs) return failure(runs.error());
  if (std::find(used.begin() + 1, used.end(), false) != used.end()) {
    return fail(ErrorCode::not_canonical, "clipboard palette has an unused material");
  }
  return touched;
}

// Reads runs until they fill the volume, and calls push(end, number) for each.
template <class Push>
void read_cells(ByteReader& r, std::uint64_t palette_size, std::uint32_t volume, Push&& push) {
  std::uint32_t filled = 0;
  std::uint64_t numbers = palette_size + 1;
  std::uint32_t before = 0xffff;  // above all numbers
  while (filled < volume) {
    const std::uint64_t code =
        r.varint_max((volume - filled) * numbers - 1, "clipboard runs end behind its volume");
    if (!r.ok()) return;
    // Most runs of a long list are one cell long, and a division is slow.
    const std::uint64_t more = code < numbers ? 0 : code / numbers;
    auto number = static_cast<std::uint32_t>(code - more * numbers);
    if (number >= before) ++number;
    filled += static_cast<std::uint32_t>(more) + 1;
    push(filled, static_cast<std::uint16_t>(number));
    before = number;
    numbers = palette_size;
  }
}

CellBox box_of_touched(const RunChunk& cells) {
  const OrderedExtent e = ordered(cells.extent, cells.order);
  std::array<std::uint32_t, 3> first = {e.f, e.m, e.s}, last = {0, 0, 0};
  const auto widen = [&](const std::array<std::uint32_t, 3>& low,
                         const std::array<std::uint32_t, 3>& high) {
    for (std::size_t rank = 0; rank < 3; ++rank) {
      first[rank] = std::min(first[rank], low[rank]);
      last[rank] = std::max(last[rank], high[rank]);
    }
  };
  cells.runs.visit([&](const auto& runs) {
    std::uint32_t begin = 0;
    std::uint32_t line_end = 0;  // of the line that was entered last
    for (std::size_t i = 0; i < runs.size(); begin = runs.end(i++)) {
      if (runs.material(i) == 0) continue;
      if (runs.end(i) <= line_end) {  // its line counts already
        const std::uint32_t line_begin = line_end - e.f;
        first[0] = std::min(first[0], begin - line_begin);
        last[0] = std::max(last[0], runs.end(i) - line_begin);
        continue;
      }
      for_each_box(e, begin, runs.end(i),
                   [&](const OrderedBox& box) { widen(box.first, box.last); });
      line_end = (runs.end(i) - 1) / e.f * e.f + e.f;
    }
  });
  const LocalPos low = from_ordered({first[0], first[1], first[2]}, cells.order);
  const LocalPos sides =
      from_ordered({last[0] - first[0], last[1] - first[1], last[2] - first[2]}, cells.order);
  return {low, {sides.x, sides.y, sides.z}};
}

}  // namespace

Result<std::shared_ptr<const Clipboard>> Clipboard::of(std::vector<Material> palette,
                                                       RunChunk cells) {
  if (const auto checked = check_palette(palette); !checked) return failure(checked.error());
  const auto touched = check_cells(cells, palette.size());
  if (!touched) return failure(touched.error());
  std::shared_ptr<Clipboard> made(new Clipboard(std::move(palette), std::move(cells)));
  made->touched_ = *touched;
  made->touched_box_ = box_of_touched(made->cells_);
  made->byte_size_ = encoded_size(made->palette_, made->cells_);
  if (made->byte_size_ > kClipboardBytesMax)
    return fail(ErrorCode::limit_exceeded, "clipboard is too long");
  return std::shared_ptr<const Clipboard>(std::move(made));
}

std::optional<Material> Clipboard::at(LocalPos place) const {
  const std::uint16_t number = material_at(cells_, place);
  if (number == 0) return std::nullopt;
  return material(number);
}

void write_clipboard(ByteWriter& w, const Clipboard& clipboard) {
  const RunChunk& cells = clipboard.cells();
  w.u8(static_cast<std::uint8_t>(cells.order));
  for (const unsigned side : cells.extent.sides()) w.u8(static_cast<std::uint8_t>(side - 1));
  for_each_varint(clipboard.palette(), cells, [&w](std::uint64_t value) { w.varint(value); });
}

std::shared_ptr<const Clipboard> read_clipboard(ByteReader& r) {
  if (r.left() > kClipboardBytesMax) r.reject(ErrorCode::limit_exceeded, "clipboard is too long");
  const std::uint8_t order = r.u8();
  if (order >= kAxisOrderCount) r.reject(ErrorCode::bad_value, "unknown axis order of a clipboard");
  std::array<std::uint8_t, 3> sides{};
  for (std::uint8_t& side : sides) {
    const std::uint8_t less_one = r.u8();
    if (less_one >= kSideMax) r.reject(ErrorCode::bad_value, "clipboard side outside 1..128");
    side = static_cast<std::uint8_t>(less_one + 1);
  }
  const std::uint64_t count = 1 + r.varint_max(kPaletteMax - 1, "clipboard has too many materials");
  if (r.ok() && count > r.left()) r.reject(ErrorCode::truncated, "clipboard palette is cut");
  if (!r.ok()) return nullptr;
  std::vector<Material> palette;
  palette.reserve(static_cast<std::size_t>(count));
  for (std::uint64_t least = 0; r.ok() && palette.size() < count; least = palette.back() + 1U) {
    if (least > 0xffff) {
      r.reject(ErrorCode::bad_value, "material id exceeds 16 bits");
    } else {
      palette.push_back(static_cast<Material>(
          least + r.varint_max(0xffff - least, "material id exceeds 16 bits")));
    }
  }
  RunChunk cells{{sides[0], sides[1], sides[2]}, static_cast<AxisOrder>(order), RunList{}};
  const std::uint32_t volume = cells.volume();
  // Each run takes at least one byte.
  const std::size_t runs_max = std::min<std::size_t>(volume, r.left());
  if (volume <= kNarrowVolumeMax) {
    std::vector<PackedRun> runs;
    runs.reserve(runs_max);
    read_cells(r, count, volume, [&](std::uint32_t end, std::uint16_t number) {
      runs.push_back({static_cast<std::uint16_t>(end), number});
    });
    cells.runs = RunList::of_narrow(std::move(runs));
  } else {
    std::vector<std::uint32_t> ends;
    std::vector<Material> numbers;
    ends.reserve(runs_max);
    numbers.reserve(runs_max);
    read_cells(r, count, volume, [&](std::uint32_t end, std::uint16_t number) {
      ends.push_back(end);
      numbers.push_back(number);
    });
    cells.runs = RunList::of_wide(std::move(ends), std::move(numbers));
  }
  if (!r.ok()) return nullptr;
  cells.runs.shrink_to_fit();
  auto clipboard = Clipboard::of(std::move(palette), std::move(cells));
  if (!clipboard) {
    r.reject(clipboard.error().code, clipboard.error().what);
    return nullptr;
  }
  return *clipboard;
}

}  // namespace runstone
