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

// Neighbouring runs differ, so a number is encoded among the numbers that the previous run does not
// have.
std::uint64_t encoded_number(std::uint16_t number, std::uint16_t before) {
  return number > before ? number - 1U : number;
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
  if (auto runs = validate_runs(cells); !runs) return Unexpected<Error>{runs.error()};
  std::vector<bool> used(palette_size + 1, false);
  std::uint32_t touched = 0, begin = 0;
  for (std::size_t i = 0; i < cells.runs.size(); ++i) {
    const Run run = cells.runs[i];
    if (run.material > palette_size)
      return fail(ErrorCode::bad_value, "clipboard cell outside the palette", i);
    used[run.material] = true;
    if (run.material != 0) touched += run.end - begin;
    begin = run.end;
  }
  if (std::find(used.begin() + 1, used.end(), false) != used.end()) {
    return fail(ErrorCode::not_canonical, "clipboard palette has an unused material");
  }
  return touched;
}

CellBox box_of_touched(const RunChunk& cells) {
  const OrderedExtent e = ordered(cells.extent, cells.order);
  std::array<std::uint32_t, 3> first = {e.f, e.m, e.s}, last = {0, 0, 0};
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < cells.runs.size(); ++i) {
    const Run run = cells.runs[i];
    if (run.material != 0) {
      for_each_box(e, begin, run.end, [&](const OrderedBox& box) {
        for (std::size_t rank = 0; rank < 3; ++rank) {
          first[rank] = std::min(first[rank], box.first[rank]);
          last[rank] = std::max(last[rank], box.last[rank]);
        }
      });
    }
    begin = run.end;
  }
  const LocalPos low = from_ordered({first[0], first[1], first[2]}, cells.order);
  const LocalPos sides =
      from_ordered({last[0] - first[0], last[1] - first[1], last[2] - first[2]}, cells.order);
  return {low, {sides.x, sides.y, sides.z}};
}

}  // namespace

Result<std::shared_ptr<const Clipboard>> Clipboard::of(std::vector<Material> palette,
                                                       RunChunk cells) {
  if (const auto checked = check_palette(palette); !checked)
    return Unexpected<Error>{checked.error()};
  const auto touched = check_cells(cells, palette.size());
  if (!touched) return Unexpected<Error>{touched.error()};
  std::shared_ptr<Clipboard> made(new Clipboard(std::move(palette), std::move(cells)));
  made->touched_ = *touched;
  made->touched_box_ = box_of_touched(made->cells_);
  Bytes bytes;
  ByteWriter w(bytes);
  write_clipboard(w, *made);
  if (bytes.size() > kClipboardBytesMax)
    return fail(ErrorCode::limit_exceeded, "clipboard is too long");
  made->byte_size_ = bytes.size();
  return std::shared_ptr<const Clipboard>(std::move(made));
}

std::optional<Material> Clipboard::at(LocalPos place) const {
  const std::uint16_t number = material_at(cells_, place);
  if (number == 0) return std::nullopt;
  return material(number);
}

void write_clipboard(ByteWriter& w, const Clipboard& clipboard) {
  const RunChunk& cells = clipboard.cells();
  const std::vector<Material>& palette = clipboard.palette();
  w.u8(static_cast<std::uint8_t>(cells.order));
  for (const unsigned side : cells.extent.sides()) w.u8(static_cast<std::uint8_t>(side - 1));
  w.varint(palette.size() - 1);
  w.varint(palette.front());
  for (std::size_t i = 1; i < palette.size(); ++i) w.varint(palette[i] - palette[i - 1] - 1U);
  std::uint32_t begin = 0;
  std::uint16_t before = 0;
  cells.runs.visit([&](const auto& runs) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::uint64_t numbers = i == 0 ? palette.size() + 1 : palette.size();
      const std::uint64_t number =
          i == 0 ? runs.material(i) : encoded_number(runs.material(i), before);
      w.varint((runs.end(i) - begin - 1) * numbers + number);
      begin = runs.end(i);
      before = runs.material(i);
    }
  });
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
  cells.runs = RunList(volume);  // in the form that the volume requires
  std::uint32_t filled = 0;
  std::uint16_t before = 0;
  while (r.ok() && filled < volume) {
    const bool first = filled == 0;
    const std::uint64_t numbers = first ? count + 1 : count;
    const std::uint64_t code =
        r.varint_max((volume - filled) * numbers - 1, "clipboard runs end behind its volume");
    if (!r.ok()) break;
    auto number = static_cast<std::uint16_t>(code % numbers);
    if (!first && number >= before) ++number;
    filled += static_cast<std::uint32_t>(code / numbers) + 1;
    before = number;
    cells.runs.push_back({filled, number});
  }
  if (!r.ok()) return nullptr;
  auto clipboard = Clipboard::of(std::move(palette), std::move(cells));
  if (!clipboard) {
    r.reject(clipboard.error().code, clipboard.error().what);
    return nullptr;
  }
  return *clipboard;
}

}  // namespace runstone
