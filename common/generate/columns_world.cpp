#include "common/generate/columns_world.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

namespace runstone {
namespace {

constexpr std::int32_t kSidesMax = 1024;
constexpr std::int32_t kHeightLimit = 4096;

/// Reads one line. `good` is false from the first character that does not belong to it.
struct LineReader {
  std::string_view left;
  bool good = true;

  std::int32_t number() {
    std::int32_t out = 0;
    const auto [end, status] = std::from_chars(left.data(), left.data() + left.size(), out);
    good = good && status == std::errc{};
    if (good) left.remove_prefix(static_cast<std::size_t>(end - left.data()));
    return out;
  }
  bool take(char c) {
    if (left.empty() || left.front() != c) return false;
    left.remove_prefix(1);
    return true;
  }
};

struct ReadColumn {
  std::int32_t x, z;
  Column column;
};

}  // namespace

Result<std::unique_ptr<ColumnsWorld>> ColumnsWorld::parse(std::string_view csv) {
  std::vector<ReadColumn> read;
  std::uint64_t line_number = 0;
  std::int32_t y_max = kBottom;
  while (!csv.empty()) {
    ++line_number;
    const std::size_t length = std::min(csv.find('\n'), csv.size());
    LineReader line{csv.substr(0, length)};
    csv.remove_prefix(std::min(length + 1, csv.size()));
    if (line_number == 1) {
      if (line.left != "x,y,runs_bottom_to_top") {
        return fail(ErrorCode::bad_version, "columns: unknown header line", 1);
      }
      continue;
    }
    ReadColumn out;
    out.x = line.number();
    line.good = line.good && line.take(',');
    out.z = line.number();
    line.good = line.good && line.take(',');
    if (std::min(out.x, out.z) < -kWorldLimit || std::max(out.x, out.z) >= kWorldLimit) {
      return fail(ErrorCode::bad_value, "columns: a place outside the world", line_number);
    }
    out.column.reset(kBottom, kBottom + kHeightLimit);
    std::int32_t y = kBottom;
    do {
      const std::int32_t id = line.number();
      line.good = line.good && line.take(':');
      const std::int32_t count = line.number();
      if (!line.good || id < -1 || id >= 65535 || count <= 0) {
        return fail(ErrorCode::bad_value, "columns: a line is not x,y,id:length|...", line_number);
      }
      if (count > kBottom + kHeightLimit - y) {
        return fail(ErrorCode::limit_exceeded, "columns: more than 4096 voxels in a column",
                    line_number);
      }
      out.column.paint(y, y + count, static_cast<Material>(id + 1));
      y += count;
    } while (line.take('|'));
    if (!line.left.empty())
      return fail(ErrorCode::bad_value, "columns: bytes after a column", line_number);
    if (!read.empty() && y != y_max) {
      return fail(ErrorCode::bad_value, "columns: columns end at different heights", line_number);
    }
    y_max = y;
    read.push_back(std::move(out));
  }
  if (read.empty()) return fail(ErrorCode::truncated, "columns: no columns", line_number);

  const auto by_place = [](const ReadColumn& a, const ReadColumn& b) {
    return std::pair(a.z, a.x) < std::pair(b.z, b.x);
  };
  std::sort(read.begin(), read.end(), by_place);
  const std::int64_t width = std::int64_t{read.back().x} - read.front().x + 1;
  const std::int64_t depth = std::int64_t{read.back().z} - read.front().z + 1;
  if (width > kSidesMax || depth > kSidesMax) {
    return fail(ErrorCode::limit_exceeded, "columns: more than 1024 columns a side", line_number);
  }
  std::unique_ptr<ColumnsWorld> world(new ColumnsWorld);
  world->x_ = read.front().x;
  world->z_ = read.front().z;
  world->width_ = static_cast<std::int32_t>(width);
  world->depth_ = static_cast<std::int32_t>(depth);
  world->y_max_ = y_max;
  // In this order a full rectangle is exactly the sequence of its places. A gap or a duplicate
  // shows as a mismatch.
  bool full = width > 0 && read.size() == static_cast<std::size_t>(width * depth);
  for (std::size_t i = 0; full && i < read.size(); ++i) {
    const auto place = static_cast<std::int32_t>(i);
    full = read[i].x == world->x_ + place % world->width_ &&
           read[i].z == world->z_ + place / world->width_;
  }
  if (!full)
    return fail(ErrorCode::bad_value, "columns: the columns do not fill a rectangle", line_number);
  world->columns_.reserve(read.size());
  for (ReadColumn& column : read) world->columns_.push_back(std::move(column.column));
  return world;
}

const Column* ColumnsWorld::column(std::int32_t x, std::int32_t z) const {
  if (x < x_ || z < z_ || x - x_ >= width_ || z - z_ >= depth_) return nullptr;
  return &columns_[static_cast<std::size_t>((x - x_) + width_ * (z - z_))];
}

RunChunk ColumnsWorld::generate(VoxelPos origin, Extent extent) const {
  if (origin.y + extent.y <= kBottom || origin.y >= y_max_) return uniform_chunk(extent, kEmpty);
  RunBuilder out(extent, AxisOrder::yxz);
  for (std::int32_t z = origin.z; z < origin.z + extent.z; ++z) {
    for (std::int32_t x = origin.x; x < origin.x + extent.x; ++x) {
      if (const Column* here = column(x, z)) {
        here->emit(origin.y, extent.y, out);
      } else {
        out.append(extent.y, kEmpty);
      }
    }
  }
  return out.finish();
}

std::int32_t ColumnsWorld::surface_y(std::int32_t x, std::int32_t z) const {
  const Column* here = column(x, z);
  return here != nullptr ? here->top() : kBottom;
}

}  // namespace runstone
