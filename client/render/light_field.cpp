#include "client/render/light_field.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr VoxelBox kNoBox{};
/// Beyond this number, boxes that wait become one.
constexpr std::size_t kDirtyMax = 64;

std::int64_t volume_of(const VoxelBox& box) {
  if (box.empty()) return 0;
  return std::int64_t{box.max.x - box.min.x} * (box.max.y - box.min.y) * (box.max.z - box.min.z);
}

VoxelBox grown(const VoxelBox& box, std::int32_t by) {
  return {{box.min.x - by, box.min.y - by, box.min.z - by},
          {box.max.x + by, box.max.y + by, box.max.z + by}};
}

std::int32_t wrapped(std::int32_t v, std::int32_t size) { return v - floor_div(v, size) * size; }

/// Returns the sky level of light that falls into a voxel from above.
std::uint8_t fallen(std::uint32_t level, LightCode code) {
  const LightPass pass = pass_of(code);
  if (pass == LightPass::opaque) return 0;
  const std::uint32_t loss = loss_of(pass);
  return static_cast<std::uint8_t>(level > loss ? level - loss : 0);
}

}  // namespace

LightField::LightField(std::int32_t width, std::int32_t height) : width_(width), height_(height) {
  RUNSTONE_ASSERT(width > 0 && height > 0 && width % (2 * kStep) == 0 && height % (2 * kStep) == 0);
}

LightField::RowCursor LightField::cursor(std::int32_t x, std::int32_t y, std::int32_t z) const {
  const auto width = static_cast<std::size_t>(width_);
  const std::size_t row =
      (static_cast<std::size_t>(wrapped(z, width_)) * static_cast<std::size_t>(height_) +
       static_cast<std::size_t>(wrapped(y, height_))) *
      width;
  return {row, static_cast<std::size_t>(wrapped(x, width_)), width};
}

std::size_t LightField::index(VoxelPos at) const { return cursor(at.x, at.y, at.z).index(); }

std::size_t LightField::byte_size() const {
  return chunk_bytes_ + codes_.capacity() * sizeof(LightCode) + falling_.capacity() +
         levels_.capacity() * sizeof(LightLevels) + flood_.byte_size();
}

void LightField::set(ChunkCoord at, std::int32_t edge, LightChunk chunk) {
  if (chunks_.empty()) edge_ = edge;
  if (edge != edge_) return;
  const auto [found, is_new] = chunks_.try_emplace(at);
  if (is_new) {
    ++heights_[at.y];
  } else {
    chunk_bytes_ -= found->second.byte_size();
  }
  const bool covers_alike = !is_new && found->second.tops == chunk.tops &&
                            (!chunk.tops.empty() || found->second.codes == chunk.codes);
  found->second = std::move(chunk);
  chunk_bytes_ += found->second.byte_size();
  mark(fill(at, &found->second, intersect(box_of(at, edge_), box_)));
  if (!covers_alike) mark_below(at);
}

void LightField::remove(ChunkCoord at) {
  const auto found = chunks_.find(at);
  if (found == chunks_.end()) return;
  chunk_bytes_ -= found->second.byte_size();
  chunks_.erase(found);
  if (--heights_[at.y] == 0) heights_.erase(at.y);
  mark(fill(at, nullptr, intersect(box_of(at, edge_), box_)));
  mark_below(at);
}

void LightField::mark_below(ChunkCoord at) {
  const VoxelBox chunk = box_of(at, edge_);
  if (chunk.max.y <= box_.max.y) return;
  mark(intersect(
      {{chunk.min.x, box_.max.y - 1, chunk.min.z}, {chunk.max.x, box_.max.y, chunk.max.z}}, box_));
}

void LightField::mark(VoxelBox dirty) {
  if (dirty.empty()) return;
  // Boxes that overlap are computed together if that costs no more.
  for (std::size_t i = 0; i < dirty_.size();) {
    const VoxelBox both = bounding_box(dirty_[i], dirty);
    const auto cost = [](const VoxelBox& box) { return volume_of(grown(box, kLightReach)); };
    if (cost(both) <= cost(dirty_[i]) + cost(dirty)) {
      dirty = both;
      dirty_[i] = dirty_.back();
      dirty_.pop_back();
      i = 0;
    } else {
      ++i;
    }
  }
  dirty_.push_back(dirty);
  if (dirty_.size() <= kDirtyMax) return;
  // The box joins the one with which it makes the smallest hull.
  const auto joined = std::min_element(
      dirty_.begin(), dirty_.end() - 1, [&dirty](const VoxelBox& a, const VoxelBox& b) {
        return volume_of(bounding_box(a, dirty)) < volume_of(bounding_box(b, dirty));
      });
  *joined = bounding_box(*joined, dirty);
  dirty_.pop_back();
}

VoxelBox LightField::fill(ChunkCoord at, const LightChunk* chunk, const VoxelBox& part) {
  if (part.empty()) return kNoBox;
  VoxelBox changed = kNoBox;
  const VoxelPos origin = origin_of(at, edge_);
  const auto fill_box = [&](const VoxelBox& whole, LightCode code) {
    const VoxelBox box = intersect(whole, part);
    if (box.empty()) return;
    for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
        RowCursor in_ring = cursor(box.min.x, y, z);
        std::int32_t first = box.max.x, last = box.min.x;
        for (std::int32_t x = box.min.x; x < box.max.x; ++x, in_ring.next()) {
          LightCode& before = codes_[in_ring.index()];
          if (before == code) continue;
          before = code;
          first = std::min(first, x);
          last = x + 1;
        }
        if (first < last) changed = bounding_box(changed, {{first, y, z}, {last, y + 1, z + 1}});
      }
    }
  };
  if (chunk == nullptr) {
    fill_box(part, 0);
    return changed;
  }
  for_each_light_box(chunk->codes, [&](const std::array<int, 3>& first,
                                       const std::array<int, 3>& last, LightCode code) {
    fill_box({{origin.x + first[0], origin.y + first[1], origin.z + first[2]},
              {origin.x + last[0], origin.y + last[1], origin.z + last[2]}},
             code);
  });
  return changed;
}

void LightField::fill_from_chunks(const VoxelBox& part) {
  if (part.empty() || edge_ == 0) return;
  const ChunkCoord first = chunk_of(part.min, edge_);
  const ChunkCoord last = chunk_of({part.max.x - 1, part.max.y - 1, part.max.z - 1}, edge_);
  for (std::int32_t x = first.x; x <= last.x; ++x) {
    for (std::int32_t y = first.y; y <= last.y; ++y) {
      for (std::int32_t z = first.z; z <= last.z; ++z) {
        const ChunkCoord at{x, y, z};
        const auto found = chunks_.find(at);
        fill(at, found == chunks_.end() ? nullptr : &found->second,
             intersect(box_of(at, edge_), part));
      }
    }
  }
}

void LightField::move_to(VoxelPos eye) {
  const VoxelPos middle{(box_.min.x + box_.max.x) / 2, (box_.min.y + box_.max.y) / 2,
                        (box_.min.z + box_.max.z) / 2};
  const auto is_near = [](std::int32_t a, std::int32_t b) { return std::abs(a - b) <= kStep; };
  if (!box_.empty() && is_near(eye.x, middle.x) && is_near(eye.y, middle.y) &&
      is_near(eye.z, middle.z))
    return;
  const auto start = [](std::int32_t at, std::int32_t size) {
    return floor_div(at - size / 2 + kStep / 2, kStep) * kStep;
  };
  const VoxelPos min{start(eye.x, width_), start(eye.y, height_), start(eye.z, width_)};
  const VoxelBox before = box_;
  box_ = {min, {min.x + width_, min.y + height_, min.z + width_}};
  const VoxelBox kept = intersect(before, box_);
  if (levels_.empty()) {
    const std::size_t volume = static_cast<std::size_t>(volume_of(box_));
    codes_.assign(volume, 0);
    falling_.assign(volume, 0);
    levels_.assign(volume, 0);
  }
  std::vector<VoxelBox> entered;
  if (kept.empty()) {
    entered.push_back(box_);
  } else {
    // The new part is a slab at each side that moved, without the voxels of an earlier slab.
    VoxelBox rest = box_;
    const auto cut = [&](std::int32_t VoxelPos::* axis) {
      VoxelBox low = rest, high = rest;
      low.max.*axis = kept.min.*axis;
      high.min.*axis = kept.max.*axis;
      entered.push_back(low);
      entered.push_back(high);
      rest.min.*axis = kept.min.*axis;
      rest.max.*axis = kept.max.*axis;
    };
    cut(&VoxelPos::x);
    cut(&VoxelPos::y);
    cut(&VoxelPos::z);
  }
  for (VoxelBox& dirty : dirty_) dirty = intersect(dirty, box_);
  std::erase_if(dirty_, [](const VoxelBox& dirty) { return dirty.empty(); });
  for (const VoxelBox& part : entered) {
    if (part.empty()) continue;
    for (std::int32_t z = part.min.z; z < part.max.z; ++z) {
      for (std::int32_t y = part.min.y; y < part.max.y; ++y) {
        RowCursor at = cursor(part.min.x, y, z);
        for (std::int32_t x = part.min.x; x < part.max.x; ++x, at.next()) {
          codes_[at.index()] = 0;
          falling_[at.index()] = 0;
          levels_[at.index()] = 0;
        }
      }
    }
    fill_from_chunks(part);
    mark(part);
  }
}

void LightField::update(VoxelPos eye, bool all, std::vector<VoxelBox>& changed) {
  move_to(eye);
  std::int64_t work = 0;
  while (!dirty_.empty() && (all || work < kWorkMax)) {
    const auto smallest = std::min_element(
        dirty_.begin(), dirty_.end(),
        [](const VoxelBox& a, const VoxelBox& b) { return volume_of(a) < volume_of(b); });
    VoxelBox part = *smallest;
    *smallest = dirty_.back();
    dirty_.pop_back();
    part.min.y = std::min(part.min.y, let_fall(part));
    part = intersect(grown(part, kLightReach), box_);
    work += volume_of(part);
    const VoxelBox of_part = relight(part);
    if (!of_part.empty()) changed.push_back(of_part);
  }
}

std::vector<std::pair<std::int32_t, const LightChunk*>> LightField::chunks_above(
    std::int32_t chunk_x, std::int32_t chunk_z) const {
  std::vector<std::pair<std::int32_t, const LightChunk*>> out;
  for (auto height = heights_.lower_bound(floor_div(box_.max.y, edge_)); height != heights_.end();
       ++height) {
    const auto found = chunks_.find({chunk_x, height->first, chunk_z});
    if (found != chunks_.end()) out.emplace_back(height->first * edge_, &found->second);
  }
  return out;
}

std::int32_t LightField::let_fall(const VoxelBox& dirty) {
  std::int32_t lowest = dirty.min.y;
  std::vector<std::pair<std::int32_t, const LightChunk*>> above;
  std::int32_t above_x = 0, above_z = 0;
  bool has_above = false;
  for (std::int32_t z = dirty.min.z; z < dirty.max.z; ++z) {
    for (std::int32_t x = dirty.min.x; x < dirty.max.x; ++x) {
      std::uint32_t level = kLightMax;
      if (dirty.max.y < box_.max.y) {
        level = falling_[index({x, dirty.max.y, z})];
      } else if (edge_ != 0) {
        const ChunkCoord chunk = chunk_of({x, 0, z}, edge_);
        if (!has_above || chunk.x != above_x || chunk.z != above_z) {
          above = chunks_above(chunk.x, chunk.z);
          above_x = chunk.x, above_z = chunk.z;
          has_above = true;
        }
        for (const auto& [y, of_chunk] : above) {
          const int top = of_chunk->top(x - chunk.x * edge_, z - chunk.z * edge_);
          if (top != 0 && y + top > box_.max.y) level = 0;
        }
      }
      std::int32_t in_ring = wrapped(dirty.max.y - 1, height_);
      const std::size_t bottom = index({x, 0, z});
      for (std::int32_t y = dirty.max.y - 1; y >= box_.min.y; --y) {
        const std::size_t i =
            bottom + static_cast<std::size_t>(in_ring) * static_cast<std::size_t>(width_);
        in_ring = in_ring == 0 ? height_ - 1 : in_ring - 1;
        level = fallen(level, codes_[i]);
        if (y < dirty.min.y) {
          if (falling_[i] == level) break;
          lowest = std::min(lowest, y);
        }
        falling_[i] = static_cast<std::uint8_t>(level);
      }
    }
  }
  return lowest;
}

VoxelBox LightField::relight(const VoxelBox& part) {
  // The flood has the part and, around it, two voxels: one that keeps its light, and a border.
  constexpr std::int32_t kRim = 2;
  const VoxelPos corner{part.min.x - kRim, part.min.y - kRim, part.min.z - kRim};
  flood_.reset(part.max.x - part.min.x + 2 * kRim, part.max.y - part.min.y + 2 * kRim,
               part.max.z - part.min.z + 2 * kRim);
  const VoxelBox loaded = intersect(grown(part, 1), box_);
  const auto in_flood = [&](VoxelPos at) {
    return flood_.index(at.x - corner.x, at.y - corner.y, at.z - corner.z);
  };
  for (std::int32_t z = loaded.min.z; z < loaded.max.z; ++z) {
    for (std::int32_t y = loaded.min.y; y < loaded.max.y; ++y) {
      RowCursor at = cursor(loaded.min.x, y, z);
      std::size_t i = in_flood({loaded.min.x, y, z});
      for (std::int32_t x = loaded.min.x; x < loaded.max.x; ++x, ++i, at.next()) {
        const std::size_t from = at.index();
        const LightCode code = codes_[from];
        const bool is_fixed = !part.contains({x, y, z});
        flood_.voxel(i) = {pass_of(code), is_fixed};
        flood_.levels(i) =
            is_fixed ? levels_[from]
                     : emission_levels(code) | static_cast<LightLevels>(falling_[from]) << 24;
      }
    }
  }
  // Sky light spreads only from columns beside darker ones. The smaller step over an edge makes a
  // difference of this much.
  constexpr std::uint32_t kDarker = kEdgeStep - kFaceStep;
  for (std::int32_t z = loaded.min.z; z < loaded.max.z; ++z) {
    for (std::int32_t y = loaded.min.y; y < loaded.max.y; ++y) {
      std::size_t i = in_flood({loaded.min.x, y, z});
      for (std::int32_t x = loaded.min.x; x < loaded.max.x; ++x, ++i) {
        const LightLevels levels = flood_.levels(i);
        if (levels == 0) continue;
        const std::uint32_t sky = sky_of(levels);
        const auto is_darker = [&](std::size_t at) {
          return flood_.voxel(at).pass != LightPass::opaque &&
                 sky_of(flood_.levels(at)) + kDarker < sky;
        };
        if (flood_.voxel(i).is_fixed || levels << 8 != 0 || is_darker(i - 1) || is_darker(i + 1) ||
            is_darker(i - flood_.stride_z()) || is_darker(i + flood_.stride_z()))
          flood_.add_source(i);
      }
    }
  }
  flood_.run();
  VoxelBox changed = kNoBox;
  for (std::int32_t z = part.min.z; z < part.max.z; ++z) {
    for (std::int32_t y = part.min.y; y < part.max.y; ++y) {
      RowCursor at = cursor(part.min.x, y, z);
      std::size_t i = in_flood({part.min.x, y, z});
      std::int32_t first = part.max.x, last = part.min.x;
      for (std::int32_t x = part.min.x; x < part.max.x; ++x, ++i, at.next()) {
        LightLevels& levels = levels_[at.index()];
        if (levels == flood_.levels(i)) continue;
        levels = flood_.levels(i);
        first = std::min(first, x);
        last = x + 1;
      }
      if (first < last) changed = bounding_box(changed, {{first, y, z}, {last, y + 1, z + 1}});
    }
  }
  return changed;
}

}  // namespace runstone
