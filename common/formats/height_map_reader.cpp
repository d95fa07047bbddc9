#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>
#include <vector>

#include "common/formats/height_map.hpp"
#include "common/formats/png_rows.hpp"
#include "common/formats/vox_look.hpp"
#include "common/materials/colour_quantiser.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

constexpr std::uint32_t kMapTile = 64;
constexpr std::size_t kMapColoursMax = 255;  // MapBand keeps their indices as bytes

/// The height in voxels and the index of the colour of the pixels of up to 64 rows.
struct MapBand {
  std::uint32_t width = 0, rows = 0;
  std::vector<std::uint32_t> heights;
  std::vector<std::uint8_t> colours;
};

Result<void> give_tile(const MapBand& band, std::uint32_t x, std::uint32_t z,
                       const std::vector<ForeignBlock>& blocks, const PieceSink& sink) {
  const std::uint32_t wide = std::min(kMapTile, band.width - x);
  std::uint32_t highest = 0;
  for (std::uint32_t row = 0; row < band.rows; ++row) {
    const auto first = band.heights.begin() + static_cast<std::ptrdiff_t>(row * band.width + x);
    highest = std::max(highest, *std::max_element(first, first + wide));
  }
  // A tile without a voxel counts for the box of the build.
  for (std::uint32_t y = 0; y == 0 || y < highest; y += kMapTile) {
    const std::uint32_t high = std::clamp(highest - y, 1U, kMapTile);
    RunBuilder runs({static_cast<std::uint8_t>(wide), static_cast<std::uint8_t>(high),
                     static_cast<std::uint8_t>(band.rows)},
                    AxisOrder::yxz);
    for (std::uint32_t row = 0; row < band.rows; ++row) {
      for (std::uint32_t column = 0; column < wide; ++column) {
        const std::size_t at = std::size_t{row} * band.width + x + column;
        const std::uint32_t filled =
            std::min(high, band.heights[at] - std::min(band.heights[at], y));
        runs.append(filled, static_cast<Material>(band.colours[at] + 1));
        runs.append(high - filled, 0);
      }
    }
    const VoxelPos origin{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y),
                          static_cast<std::int32_t>(z)};
    if (auto taken = sink({origin, runs.finish(), blocks}); !taken) return taken;
  }
  return {};
}

Result<ColourQuantiser> quantiser_of(ByteView file, const PngHead& head, std::size_t colours_max) {
  auto rows = PngRows::open(file, PngRows::Pixel::rgb8);
  if (!rows) return failure(rows.error());
  ColourQuantiser out;
  std::vector<std::uint8_t> row(std::size_t{head.width} * 3);
  for (std::uint32_t z = 0; z < head.height; ++z) {
    if (auto read = rows->read(row); !read) return failure(read.error());
    for (std::size_t i = 0; i < row.size(); i += 3) out.add({row[i], row[i + 1], row[i + 2]});
  }
  out.choose(colours_max);
  return out;
}

std::uint32_t map_height_max(const HeightMapOptions& options, const PngHead& head) {
  if (options.height_max != 0) return options.height_max;
  std::uint32_t out = 0;
  const std::string_view text = head.height_max;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  const bool is_number = error == std::errc{} && end == text.data() + text.size();
  return is_number && out >= 1 && out <= kHeightMapHeightMax ? out : 255;
}

}  // namespace

Result<ForeignInfo> read_height_map(ByteView heights, ByteView colours,
                                    const HeightMapOptions& options, const PieceSink& sink) {
  if (options.height_max > kHeightMapHeightMax || options.colours_max < 1 ||
      options.colours_max > kMapColoursMax)
    return fail(ErrorCode::bad_value,
                "height map: height must be 1 .. 65535, and colours 1 .. 255");
  const auto head = read_png_head(heights, kHeightMapSideMax);
  if (!head) return failure(head.error());
  if (!head->is_grey) return fail(ErrorCode::bad_value, "height map: is not grey", 25);
  std::vector<ForeignBlock> blocks;
  std::optional<ColourQuantiser> quantiser;
  std::optional<PngRows> colour_rows;
  if (colours.empty()) {
    blocks.push_back({options.ground, ""});
  } else {
    const auto colour_head = read_png_head(colours, kHeightMapSideMax);
    if (!colour_head) return failure(colour_head.error());
    if (colour_head->width != head->width || colour_head->height != head->height)
      return fail(ErrorCode::bad_value, "height map: the colour map has another size", 16);
    auto counted = quantiser_of(colours, *colour_head, options.colours_max);
    if (!counted) return failure(counted.error());
    quantiser = *std::move(counted);
    for (const auto& rgb : quantiser->colours()) {
      const MaterialColour colour{rgb[0], rgb[1], rgb[2], 255};
      blocks.push_back({"colour " + vox_colour_text(colour), "", ForeignLook{colour}});
    }
    auto opened = PngRows::open(colours, PngRows::Pixel::rgb8);
    if (!opened) return failure(opened.error());
    colour_rows = *std::move(opened);
  }
  auto rows = PngRows::open(heights, PngRows::Pixel::grey16);
  if (!rows) return failure(rows.error());
  const std::uint64_t height_max = map_height_max(options, *head);
  MapBand band;
  band.width = head->width;
  band.heights.resize(std::size_t{kMapTile} * head->width);
  band.colours.resize(band.heights.size());
  std::vector<std::uint8_t> row(std::size_t{head->width} * 2), colour_row;
  if (colour_rows) colour_row.resize(std::size_t{head->width} * 3);
  for (std::uint32_t z = 0; z < head->height; z += kMapTile) {
    band.rows = std::min(kMapTile, head->height - z);
    for (std::uint32_t k = 0; k < band.rows; ++k) {
      if (auto read = rows->read(row); !read) return failure(read.error());
      if (colour_rows) {
        if (auto read = colour_rows->read(colour_row); !read) return failure(read.error());
      }
      for (std::size_t x = 0; x < band.width; ++x) {
        const std::size_t at = std::size_t{k} * band.width + x;
        // Samples of 8 bits were widened, so that 255 became 65,535.
        const std::uint64_t sample = std::uint64_t{row[2 * x]} << 8 | row[2 * x + 1];
        band.heights[at] = static_cast<std::uint32_t>((sample * height_max + 32'767) / 65'535);
        if (quantiser)
          band.colours[at] = static_cast<std::uint8_t>(quantiser->index_of(
              {colour_row[3 * x], colour_row[3 * x + 1], colour_row[3 * x + 2]}));
      }
    }
    for (std::uint32_t x = 0; x < band.width; x += kMapTile) {
      if (auto given = give_tile(band, x, z, blocks, sink); !given) return failure(given.error());
    }
  }
  if (auto finished = rows->finish(); !finished) return failure(finished.error());
  if (colour_rows) {
    if (auto finished = colour_rows->finish(); !finished) return failure(finished.error());
  }
  return ForeignInfo{};
}

Result<ForeignInfo> read_height_map(ByteView heights, const PieceSink& sink) {
  return read_height_map(heights, {}, {}, sink);
}

}  // namespace runstone
