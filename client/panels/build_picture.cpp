#include "client/panels/build_picture.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "common/core/assert.hpp"
#include "common/materials/visibility_as_cube.hpp"

namespace runstone {
namespace {

constexpr double kShadeTop = 1.1, kShadeLeft = 0.88, kShadeRight = 0.68;
constexpr std::int32_t kCellPixelsMax = 32;  // half of the width of a cell

/// The build in coarse cells: the index of the material of each + 1, or 0 for nothing.
struct CoarseCells {
  std::int32_t x = 1, y = 1, z = 1;
  std::vector<std::uint32_t> cells;

  std::uint32_t at(std::int32_t i, std::int32_t j, std::int32_t k) const {
    if (i >= x || j >= y || k >= z) return 0;
    return cells[static_cast<std::size_t>(i + x * (j + y * k))];
  }
};

/// Returns the two cells along an axis, the farther one first, at which coarse cell `index` of `width`
/// cells is looked up. They may be one. Requires index * width < side.
std::array<std::int32_t, 2> looked_up(std::int32_t index, std::int32_t width, std::int32_t side) {
  const std::int32_t first = index * width;
  const std::int32_t last = std::min(width, side - first) - 1;
  return {first + last - last / 4, first + last / 4};
}

CoarseCells coarse_cells(const Build& build, const std::vector<std::uint32_t>& shown) {
  const VoxelPos sides = build.sides();
  const std::int32_t longest = std::max({sides.x, sides.y, sides.z});
  const std::int32_t width = (longest + kBuildPictureCells - 1) / kBuildPictureCells;
  const auto along = [&](std::int32_t side) { return (side + width - 1) / width; };
  CoarseCells out{along(sides.x), along(sides.y), along(sides.z), {}};
  const auto look_up = [&](std::int32_t i, std::int32_t j, std::int32_t k) -> std::uint32_t {
    if (width == 1) {
      const auto material = build.at({i, j, k});
      return material ? shown[*material] : 0;
    }
    for (const std::int32_t y : looked_up(j, width, sides.y)) {
      for (const std::int32_t x : looked_up(i, width, sides.x)) {
        for (const std::int32_t z : looked_up(k, width, sides.z)) {
          const auto material = build.at({x, y, z});
          if (material && shown[*material] != 0) return shown[*material];
        }
      }
    }
    return 0;
  };
  out.cells.reserve(static_cast<std::size_t>(out.x) * static_cast<std::size_t>(out.y) *
                    static_cast<std::size_t>(out.z));
  for (std::int32_t k = 0; k < out.z; ++k) {
    for (std::int32_t j = 0; j < out.y; ++j) {
      for (std::int32_t i = 0; i < out.x; ++i) out.cells.push_back(look_up(i, j, k));
    }
  }
  return out;
}

/// Returns the colour with this brightness, without alpha.
std::array<std::uint8_t, 3> shaded(const MaterialColour& colour, double factor) {
  std::array<std::uint8_t, 3> out{};
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = static_cast<std::uint8_t>(std::min(255.0, colour[i] * factor));
  return out;
}

class CellPainter {
 public:
  /// `half` is half of the width of a cell in pixels, and even. `image` must outlive the object.
  CellPainter(OverlayImage& image, std::int32_t half) : image_(image), half_(half) {}

  /// Paints a cell with its upper left corner at this pixel. The cell is 2 * half wide and high.
  void paint(std::int32_t left, std::int32_t top, const MaterialColour& colour) {
    const std::uint32_t alpha = std::max<std::uint32_t>(colour[3], 48);
    const auto up = shaded(colour, kShadeTop), west = shaded(colour, kShadeLeft),
               east = shaded(colour, kShadeRight);
    for (std::int32_t column = 0; column < 2 * half_; ++column) {
      const std::int32_t beside = column < half_ ? half_ - 1 - column : column - half_;
      const std::int32_t from = top + beside / 2, middle = top + half_ - beside / 2;
      for (std::int32_t y = from; y < middle; ++y) blend(left + column, y, up, alpha);
      for (std::int32_t y = middle; y < middle + half_; ++y)
        blend(left + column, y, column < half_ ? west : east, alpha);
    }
  }

 private:
  void blend(std::int32_t x, std::int32_t y, const std::array<std::uint8_t, 3>& colour,
             std::uint32_t alpha) {
    if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
    std::uint32_t& pixel = image_.pixels[static_cast<std::size_t>(y * image_.width + x)];
    const std::uint32_t below = pixel >> 24;
    std::uint32_t out = std::min<std::uint32_t>(255, alpha + below * (255 - alpha) / 255) << 24;
    for (unsigned i = 0; i < 3; ++i) {
      const std::uint32_t before = below == 0 ? colour[i] : pixel >> (8 * i) & 255U;
      out |= ((colour[i] * alpha + before * (255 - alpha)) / 255) << (8 * i);
    }
    pixel = out;
  }

  OverlayImage& image_;
  const std::int32_t half_;
};

}  // namespace

std::shared_ptr<const OverlayImage> build_picture(const Build& build,
                                                  std::span<const MaterialRow> rows) {
  RUNSTONE_ASSERT(rows.size() == build.palette().size());
  std::vector<std::uint32_t> shown(std::size_t{1} << 16, 0);  // by material: its row + 1
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (visibility_as_cube(rows[i]) != Visibility::empty)
      shown[build.palette()[i]] = static_cast<std::uint32_t>(i + 1);
  }
  const CoarseCells cells = coarse_cells(build, shown);
  const std::int32_t diagonal = cells.x + cells.z;
  const std::int32_t room =
      std::min({kBuildPicturePixels / diagonal, 2 * kBuildPicturePixels / (diagonal + 2 * cells.y),
                kCellPixelsMax});
  const std::int32_t half = std::max(2, room / 2 * 2);  // even
  auto image = std::make_shared<OverlayImage>();
  image->width = diagonal * half;
  image->height = diagonal * half / 2 + cells.y * half;
  image->pixels.assign(
      static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height), 0);
  CellPainter painter(*image, half);
  const auto hides = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const std::uint32_t row = cells.at(i, j, k);
    return row != 0 && rows[row - 1].visibility == Visibility::opaque;
  };
  // The far cells come first.
  for (std::int32_t j = 0; j < cells.y; ++j) {
    for (std::int32_t k = 0; k < cells.z; ++k) {
      for (std::int32_t i = 0; i < cells.x; ++i) {
        const std::uint32_t row = cells.at(i, j, k);
        if (row == 0) continue;
        if (hides(i + 1, j, k) && hides(i, j + 1, k) && hides(i, j, k + 1)) continue;
        painter.paint((i - k + cells.z - 1) * half, (i + k) * half / 2 + (cells.y - 1 - j) * half,
                      rows[row - 1].colour);
      }
    }
  }
  return image;
}

}  // namespace runstone
