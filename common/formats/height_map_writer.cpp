#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/assert.hpp"
#include "common/formats/deflate.hpp"
#include "common/formats/height_map.hpp"
#include "common/materials/visibility_as_cube.hpp"
#include "common/runs/column_tops.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kMapWriteTile = 128;
constexpr int kPngLevel = 6;
constexpr std::size_t kPngPartBytes = std::size_t{1} << 16;

/// Writes a PNG row by row, without filters.
class PngWriter {
 public:
  explicit PngWriter(const FormatSink& sink) : sink_(sink) {}

  /// `kind`: 0 is grey, and 2 is red, green and blue.
  Result<void> begin(VoxelPos sides, std::uint8_t bits, std::uint8_t kind, std::string_view text) {
    constexpr std::uint8_t kMark[] = {0x89, 'P', 'N', 'G', 13, 10, 26, 10};
    if (!sink_(kMark)) return broken();
    Bytes head;
    append_u32(head, static_cast<std::uint32_t>(sides.x));
    append_u32(head, static_cast<std::uint32_t>(sides.z));
    head.insert(head.end(), {bits, kind, 0, 0, 0});
    if (auto done = chunk("IHDR", head); !done) return done;
    if (text.empty()) return {};
    return chunk("tEXt", {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  /// Requires the byte of the filter, 0, before the pixels.
  Result<void> row(ByteView bytes) {
    deflater_.write(bytes);
    return give_packed();
  }
  Result<void> end() {
    deflater_.finish();
    if (auto done = give_packed(); !done) return done;
    if (auto done = chunk("IDAT", packed_); !done) return done;
    return chunk("IEND", {});
  }

 private:
  static void append_u32(Bytes& out, std::uint32_t number) {
    for (const unsigned shift : {24U, 16U, 8U, 0U})
      out.push_back(static_cast<std::uint8_t>(number >> shift));
  }
  static Unexpected<Error> broken() {
    return fail(ErrorCode::io_failed, "height map: cannot be written");
  }
  /// Gives the packed bytes as chunks of one size, and keeps the rest.
  Result<void> give_packed() {
    std::size_t at = 0;
    for (; packed_.size() - at >= kPngPartBytes; at += kPngPartBytes) {
      if (auto done = chunk("IDAT", ByteView(packed_).subspan(at, kPngPartBytes)); !done)
        return done;
    }
    packed_.erase(packed_.begin(), packed_.begin() + static_cast<std::ptrdiff_t>(at));
    return {};
  }
  Result<void> chunk(std::string_view id, ByteView content) {
    Bytes out;
    append_u32(out, static_cast<std::uint32_t>(content.size()));
    out.insert(out.end(), id.begin(), id.end());
    out.insert(out.end(), content.begin(), content.end());
    append_u32(out, static_cast<std::uint32_t>(crc32_z(0, out.data() + 4, out.size() - 4)));
    if (!sink_(out)) return broken();
    return {};
  }

  const FormatSink& sink_;
  Bytes packed_;
  Deflater deflater_{DeflateForm::zlib, kPngLevel, packed_};
};

/// Finds the highest cells of the columns with z from `first` on, up to 128 rows. A material is a cell
/// number.
std::vector<ColumnTop> tops_of_rows(const FileBuild& build, std::int32_t first) {
  const Build& voxels = *build.build;
  ShowingMaterials showing = {false};
  for (const BuildMaterial& material : build.materials)
    showing.push_back(visibility_as_cube(material.row) != Visibility::empty);
  const VoxelPos sides = voxels.sides();
  const std::int32_t rows = std::min(kMapWriteTile, sides.z - first);
  std::vector<ColumnTop> out(static_cast<std::size_t>(sides.x) * static_cast<std::size_t>(rows));
  for (std::int32_t x = 0; x < sides.x; x += kMapWriteTile) {
    const std::int32_t wide = std::min(kMapWriteTile, sides.x - x);
    std::vector<ColumnTop> tile(static_cast<std::size_t>(wide) * static_cast<std::size_t>(rows));
    std::size_t open = tile.size();
    for (std::int32_t end = sides.y; end > 0 && open > 0; end -= kMapWriteTile) {
      const std::int32_t y = std::max(0, end - kMapWriteTile);
      const RunChunk cells = cells_in(voxels, {{x, y, first}, {x + wide, end, first + rows}});
      open -= find_column_tops(cells, y, showing, tile);
    }
    for (std::int32_t row = 0; row < rows; ++row) {
      std::copy_n(tile.begin() + static_cast<std::ptrdiff_t>(row) * wide, wide,
                  out.begin() + static_cast<std::ptrdiff_t>(row) * sides.x + x);
    }
  }
  return out;
}

/// Writes a picture, of which `pixel` appends the bytes of a top.
template <class F>
Result<void> write_map(const FileBuild& build, std::uint8_t bits, std::uint8_t kind,
                       std::string_view text, const FormatSink& sink, F&& pixel) {
  RUNSTONE_ASSERT(build.materials.size() == build.build->palette().size());
  const VoxelPos sides = build.build->sides();
  PngWriter out(sink);
  if (auto done = out.begin(sides, bits, kind, text); !done) return done;
  Bytes row;
  for (std::int32_t z = 0; z < sides.z; z += kMapWriteTile) {
    const std::vector<ColumnTop> tops = tops_of_rows(build, z);
    const auto wide = static_cast<std::size_t>(sides.x);
    for (std::size_t begin = 0; begin < tops.size(); begin += wide) {
      row.assign(1, 0);
      for (std::size_t i = begin; i < begin + wide; ++i) pixel(tops[i], row);
      if (auto done = out.row(row); !done) return done;
    }
  }
  return out.end();
}

Result<void> check_map_sides(const Build& build) {
  const VoxelPos sides = build.sides();
  if (std::max(sides.x, sides.z) > static_cast<std::int32_t>(kHeightMapSideMax))
    return fail(ErrorCode::limit_exceeded, "height map: build is longer than 8192 voxels");
  if (sides.y > static_cast<std::int32_t>(kHeightMapHeightMax))
    return fail(ErrorCode::limit_exceeded, "height map: build is higher than 65535 voxels");
  return {};
}

}  // namespace

Result<void> write_height_map(const FileBuild& build, const FormatSink& sink) {
  if (auto fits = check_map_sides(*build.build); !fits) return fits;
  const bool is_wide = build.build->sides().y > 255;
  constexpr std::string_view kText(
      "runstone:height_max\0"
      "65535",
      25);
  return write_map(build, is_wide ? 16 : 8, 0, is_wide ? kText : std::string_view(), sink,
                   [&](const ColumnTop& top, Bytes& row) {
                     const auto height = static_cast<std::uint32_t>(top.is_found() ? top.y + 1 : 0);
                     if (is_wide) row.push_back(static_cast<std::uint8_t>(height >> 8));
                     row.push_back(static_cast<std::uint8_t>(height));
                   });
}

Result<void> write_colour_map(const FileBuild& build, const FormatSink& sink) {
  if (auto fits = check_map_sides(*build.build); !fits) return fits;
  return write_map(build, 8, 2, {}, sink, [&](const ColumnTop& top, Bytes& row) {
    MaterialColour colour{0, 0, 0, 255};
    if (top.is_found()) colour = build.materials[top.material - 1U].row.colour;
    row.insert(row.end(), colour.begin(), colour.begin() + 3);
  });
}

}  // namespace runstone
