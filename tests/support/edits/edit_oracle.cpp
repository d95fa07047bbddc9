#include "tests/support/edits/edit_oracle.hpp"

#include <algorithm>
#include <ostream>

#include "common/edits/clipboard/clipboard_builder.hpp"
#include "common/runs/reorder.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone {

std::ostream& operator<<(std::ostream& out, const EditDescriptor& edit) {
  const auto print = [&out](VoxelPos p) { out << '(' << p.x << ',' << p.y << ',' << p.z << ')'; };
  if (const auto* voxel = std::get_if<SetVoxel>(&edit.shape)) {
    out << "voxel ";
    print(voxel->at);
  } else if (const auto* box = std::get_if<FillBox>(&edit.shape)) {
    out << "box ";
    print(box->box.min);
    out << " .. ";
    print(box->box.max);
  } else if (const auto* sphere = std::get_if<FillSphere>(&edit.shape)) {
    out << "sphere ";
    print(sphere->centre);
    out << " r " << sphere->radius;
  } else if (const auto* stroke = std::get_if<FillStroke>(&edit.shape)) {
    out << "stroke";
    for (const VoxelPos& p : stroke->points) {
      out << ' ';
      print(p);
    }
    out << " r " << stroke->radius;
  } else if (const auto* paste = std::get_if<Paste>(&edit.shape)) {
    const Clipboard& clipboard = *paste->clipboard;
    out << "paste ";
    print(paste->at);
    out << " orientation " << static_cast<int>(paste->orientation.to_byte()) << " order "
        << static_cast<int>(clipboard.cells().order);
    for (const unsigned side : clipboard.extent().sides()) out << ' ' << side;
    out << " touched " << clipboard.touched();
  }
  out << " := " << edit.material;
  switch (edit.mask.kind) {
    case MaskKind::everything:
      break;
    case MaskKind::only_empty:
      out << " where empty";
      break;
    case MaskKind::only_solid:
      out << " where solid";
      break;
    case MaskKind::only_material:
      out << " where = " << edit.mask.material;
      break;
  }
  return out;
}

}  // namespace runstone

namespace runstone::test {
namespace {

bool is_admitted(const Mask& mask, Material present) {
  if (mask.kind == MaskKind::only_empty) return present == 0;
  if (mask.kind == MaskKind::only_solid) return present > 0;
  if (mask.kind == MaskKind::only_material) return present == mask.material;
  return true;
}

std::int32_t pick(SplitMix64& rng, std::int32_t low, std::int32_t high) {
  return high < low ? low : rng.between(low, high);
}

// Finds the nearest point of the segment, in units of 1 / |ab|^2, then the distance to it, squared
// as it is defined.
bool near_segment(VoxelPos a, VoxelPos b, VoxelPos at, std::int64_t reach) {
  // Most voxels are far away along one axis.
  const auto far = [reach](std::int64_t from, std::int64_t to, std::int64_t c) {
    const std::int64_t d = std::max(std::min(from, to) - c, c - std::max(from, to));
    return d > 0 && d * d > reach;
  };
  if (far(a.x, b.x, at.x) || far(a.y, b.y, at.y) || far(a.z, b.z, at.z)) return false;
  __extension__ using SignedWide = __int128;
  const std::array<SignedWide, 3> d = {b.x - a.x, b.y - a.y, b.z - a.z};
  const std::array<SignedWide, 3> p = {SignedWide{at.x} - a.x, SignedWide{at.y} - a.y,
                                       SignedWide{at.z} - a.z};
  const SignedWide whole = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  const SignedWide place =
      std::clamp<SignedWide>(p[0] * d[0] + p[1] * d[1] + p[2] * d[2], 0, whole);
  SignedWide squared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const SignedWide off = p[i] * whole - place * d[i];
    squared += off * off;
  }
  return squared <= reach * whole * whole;
}

// Returns cell numbers voxel by voxel. Keeps the last clipboard, since the oracle reads cell after
// cell.
const DenseChunk& dense_cells(const std::shared_ptr<const Clipboard>& clipboard) {
  thread_local std::vector<std::pair<std::shared_ptr<const Clipboard>, DenseChunk>> kept;
  for (const auto& [key, cells] : kept) {
    if (key == clipboard) return cells;
  }
  if (kept.size() == 64) kept.clear();
  const RunChunk& runs = clipboard->cells();
  DenseChunk cells(runs.extent);
  std::size_t run = 0;
  for (std::uint32_t i = 0; i < runs.volume(); ++i) {
    if (i == runs.runs.end(run)) ++run;
    const VoxelPos p = dense_pos(runs.extent, runs.order, i);
    cells.set(p.x, p.y, p.z, runs.runs.material(run));
  }
  return kept.emplace_back(clipboard, std::move(cells)).second;
}

std::optional<Material> pasted(const Paste& paste, VoxelPos at, bool turned) {
  const char* const names[6] = {"xyz", "xzy", "yxz", "yzx", "zxy", "zyx"};
  const int byte = turned ? paste.orientation.to_byte() : 0;
  const DenseChunk& cells = dense_cells(paste.clipboard);
  const std::array<int, 3> off = {at.x - paste.at.x, at.y - paste.at.y, at.z - paste.at.z};
  const std::array<int, 3> sides = {cells.side_x(), cells.side_y(), cells.side_z()};
  std::array<int, 3> cell{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(names[byte / 8][i] - 'x');
    const bool backwards = (byte % 8 & (1 << i)) != 0;
    cell[axis] = backwards ? sides[axis] - 1 - off[i] : off[i];
  }
  if (!cells.inside(cell[0], cell[1], cell[2])) return std::nullopt;
  const Material number = cells.at(cell[0], cell[1], cell[2]);
  if (number == 0) return std::nullopt;
  return paste.clipboard->palette().at(number - 1U);
}

}  // namespace

std::optional<Material> oracle_writes(const EditDescriptor& edit, VoxelPos at, OracleFault fault) {
  if (const auto* paste = std::get_if<Paste>(&edit.shape)) {
    return pasted(*paste, at, fault != OracleFault::unturned_paste);
  }
  if (!oracle_covers(edit, at, fault)) return std::nullopt;
  return edit.material;
}

bool oracle_covers(const EditDescriptor& edit, VoxelPos at, OracleFault fault) {
  if (std::holds_alternative<Paste>(edit.shape)) return oracle_writes(edit, at, fault).has_value();
  if (const auto* voxel = std::get_if<SetVoxel>(&edit.shape)) {
    return voxel->at.x == at.x && voxel->at.y == at.y && voxel->at.z == at.z;
  }
  if (const auto* fill = std::get_if<FillBox>(&edit.shape)) {
    const VoxelBox& b = fill->box;
    const bool below = at.x < b.max.x && at.y < b.max.y && at.z < b.max.z;
    const bool above = at.x >= b.min.x && at.y >= b.min.y && at.z >= b.min.z;
    return below && above;
  }
  if (const auto* stroke = std::get_if<FillStroke>(&edit.shape)) {
    const std::int64_t r = stroke->radius;
    const std::int64_t rim = fault == OracleFault::thin_stroke ? 0 : r;
    for (std::size_t i = 1; i < stroke->points.size(); ++i) {
      if (near_segment(stroke->points[i - 1], stroke->points[i], at, r * r + rim)) return true;
    }
    return false;
  }
  if (!has_voxels(edit)) return false;
  // |d| < r + 1/2, with both sides doubled and squared.
  const auto& sphere = std::get<FillSphere>(edit.shape);
  const std::int64_t dx = 2 * (static_cast<std::int64_t>(at.x) - sphere.centre.x);
  const std::int64_t dy = 2 * (static_cast<std::int64_t>(at.y) - sphere.centre.y);
  const std::int64_t dz = 2 * (static_cast<std::int64_t>(at.z) - sphere.centre.z);
  const int rim = fault == OracleFault::thin_sphere ? 0 : 1;
  const std::int64_t diameter = 2 * static_cast<std::int64_t>(sphere.radius) + rim;
  if (rim == 0) return dx * dx + dy * dy + dz * dz <= diameter * diameter;
  return dx * dx + dy * dy + dz * dz < diameter * diameter;
}

OracleOutcome oracle_apply(DenseChunk& chunk, VoxelPos origin,
                           std::span<const EditDescriptor> edits, OracleFault fault) {
  OracleOutcome outcome;
  std::array<int, 3> last{};
  Material last_before = 0;
  for (int z = 0; z < chunk.side_z(); ++z) {
    for (int y = 0; y < chunk.side_y(); ++y) {
      for (int x = 0; x < chunk.side_x(); ++x) {
        const Material before = chunk.at(x, y, z);
        Material now = before;
        for (const EditDescriptor& edit : edits) {
          const auto written =
              oracle_writes(edit, {origin.x + x, origin.y + y, origin.z + z}, fault);
          const Material judged = fault == OracleFault::early_mask ? before : now;
          if (written && is_admitted(edit.mask, judged)) now = *written;
        }
        if (now == before) continue;
        chunk.set(x, y, z, now);
        last = {x, y, z};
        last_before = before;
        ++outcome.voxels_changed;
        outcome.dirty[0].insert(static_cast<unsigned>(x));
        outcome.dirty[1].insert(static_cast<unsigned>(y));
        outcome.dirty[2].insert(static_cast<unsigned>(z));
      }
    }
  }
  if (outcome.voxels_changed == 0) return outcome;
  if (fault == OracleFault::lost_voxel) chunk.set(last[0], last[1], last[2], last_before);
  if (fault == OracleFault::miscounted_voxel) ++outcome.voxels_changed;
  return outcome;
}

std::vector<VoxelPos> oracle_voxels(const EditDescriptor& edit, VoxelPos around,
                                    std::int32_t reach) {
  std::vector<VoxelPos> out;
  for (std::int32_t x = around.x - reach; x <= around.x + reach; ++x) {
    for (std::int32_t y = around.y - reach; y <= around.y + reach; ++y) {
      for (std::int32_t z = around.z - reach; z <= around.z + reach; ++z) {
        if (oracle_covers(edit, {x, y, z})) out.push_back({x, y, z});
      }
    }
  }
  return out;
}

std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> oracle_areas(
    const RunChunk& before, const RunChunk& after) {
  // Lists runs as (begin, end, material). A run in both lists is kept.
  using Listed = std::tuple<std::uint32_t, std::uint32_t, Material>;
  const auto list = [](const RunChunk& chunk) {
    std::vector<Listed> runs;
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < chunk.runs.size(); ++i) {
      runs.emplace_back(begin, chunk.runs.end(i), chunk.runs.material(i));
      begin = chunk.runs.end(i);
    }
    return runs;
  };
  const std::vector<Listed> old_runs = list(before);
  const std::vector<Listed> new_runs = list(after);
  const std::set<Listed> old_set(old_runs.begin(), old_runs.end());
  const std::set<Listed> new_set(new_runs.begin(), new_runs.end());
  std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> areas;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < old_runs.size() || j < new_runs.size()) {
    const std::size_t i0 = i;
    const std::size_t j0 = j;
    while (i < old_runs.size() && new_set.count(old_runs[i]) == 0) ++i;
    while (j < new_runs.size() && old_set.count(new_runs[j]) == 0) ++j;
    if (i != i0 || j != j0) {
      areas.emplace_back(static_cast<std::uint32_t>(j0), static_cast<std::uint32_t>(i - i0),
                         static_cast<std::uint32_t>(j - j0));
    }
    ++i;  // a kept run, in both lists
    ++j;
  }
  return areas;
}

std::vector<IndexSpan> oracle_spans(const EditDescriptor& edit, VoxelPos origin, Extent extent,
                                    AxisOrder order) {
  std::vector<IndexSpan> spans;
  for (std::uint32_t i = 0; i < extent.volume(); ++i) {
    const VoxelPos p = dense_pos(extent, order, i);
    if (!oracle_covers(edit, {origin.x + p.x, origin.y + p.y, origin.z + p.z})) continue;
    if (spans.empty() || spans.back().last != i) spans.push_back({i, i});
    ++spans.back().last;
  }
  return spans;
}

FillStroke random_stroke(SplitMix64& rng, VoxelPos at) {
  FillStroke stroke;
  stroke.radius = static_cast<std::uint16_t>(1 + rng.below(rng.below(4) == 0 ? 9 : 3));
  const auto count = rng.below(3) == 0 ? 2 : 2 + rng.below(5);
  const std::int32_t step = rng.below(3) == 0 ? 30 : 9;
  stroke.points.push_back(at);
  while (stroke.points.size() < count) {
    VoxelPos next = stroke.points.back();
    // Draws points that are often along an axis or a plane, and never far from the start.
    const auto wander = [&](std::int32_t& c, std::int32_t home) {
      if (rng.below(3) != 0) c = std::clamp(c + rng.between(-step, step), home - 24, home + 24);
    };
    wander(next.x, at.x);
    wander(next.y, at.y);
    wander(next.z, at.z);
    if (next != stroke.points.back()) stroke.points.push_back(next);
  }
  return stroke;
}

std::shared_ptr<const Clipboard> random_clipboard(SplitMix64& rng, unsigned side_max,
                                                  unsigned material_count) {
  const auto side = [&] {
    const bool long_one = rng.below(4) == 0;
    return static_cast<std::uint8_t>(1 + rng.below(long_one ? side_max : std::min(side_max, 7U)));
  };
  const Extent extent{side(), side(), side()};
  const AxisOrder order = random_order(rng);
  // Clipboards range from one stretch per cell to a few long ones, and from all cells touched to
  // hardly any.
  const std::uint32_t stretch_max = rng.below(3) == 0 ? 1 : rng.below(2) == 0 ? 9 : extent.volume();
  const std::uint32_t untouched_of_8 = rng.below(8);
  ClipboardBuilder builder(extent, order);
  builder.append(1, static_cast<Material>(rng.below(material_count)));  // some cell is touched
  while (builder.filled() < extent.volume()) {
    const std::uint32_t count =
        std::min(1 + rng.below(stretch_max), extent.volume() - builder.filled());
    if (rng.below(8) < untouched_of_8) {
      builder.append(count, std::nullopt);
    } else {
      builder.append(count, static_cast<Material>(rng.below(material_count)));
    }
  }
  const auto cheapest = *builder.finish();
  // The clipboard of a descriptor may have any axis order.
  if (rng.below(2) == 0) return cheapest;
  return *Clipboard::of(cheapest->palette(), reorder(cheapest->cells(), random_order(rng)));
}

Orientation random_orientation(SplitMix64& rng) {
  return *Orientation::of_byte(static_cast<std::uint8_t>(rng.below(kOrientationCount)));
}

EditDescriptor random_edit_near(SplitMix64& rng, VoxelPos origin, Extent extent) {
  EditDescriptor edit;
  const std::array<std::int32_t, 3> sides = {extent.x, extent.y, extent.z};
  const std::array<std::int32_t, 3> low = {origin.x, origin.y, origin.z};
  std::array<std::int32_t, 3> at{};
  std::array<std::int32_t, 3> end{};
  const std::int32_t margin = rng.below(4) == 0 ? 12 : 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const bool at_border = rng.below(4) == 0;
    at[i] = at_border ? (rng.below(2) == 0 ? 0 : sides[i] - 1)
                      : pick(rng, -margin, sides[i] - 1 + margin);
    end[i] = at[i] + 1 + static_cast<std::int32_t>(rng.below(rng.below(3) == 0 ? 40 : 6));
    if (rng.below(8) == 0) {  // whole lines and layers
      at[i] = 0 - static_cast<std::int32_t>(rng.below(2));
      end[i] = sides[i] + static_cast<std::int32_t>(rng.below(2));
    }
    at[i] += low[i];
    end[i] += low[i];
  }
  switch (rng.below(5)) {
    case 0:
      edit.shape = SetVoxel{{at[0], at[1], at[2]}};
      break;
    case 3: {
      Paste paste{{at[0], at[1], at[2]}, random_clipboard(rng, 30, 8), random_orientation(rng)};
      // Often the paste reaches into the chunk from below.
      if (rng.below(2) == 0) paste.at.x -= paste.clipboard->extent().y / 2;
      if (rng.below(2) == 0) paste.at.z -= paste.clipboard->extent().x / 2;
      edit.shape = paste;
      break;
    }
    case 1:
      edit.shape = FillBox{{{at[0], at[1], at[2]}, {end[0], end[1], end[2]}}};
      break;
    case 2:
      edit.shape = random_stroke(rng, {at[0], at[1], at[2]});
      break;
    default: {
      const std::uint32_t size = rng.below(8);
      const auto radius = static_cast<std::uint16_t>(rng.below(size == 0 ? 60 : size < 3 ? 20 : 6));
      edit.shape = FillSphere{{at[0], at[1], at[2]}, radius};
    }
  }
  edit.material = static_cast<Material>(rng.below(3) == 0 ? 0 : rng.below(8));
  if (std::holds_alternative<Paste>(edit.shape)) edit.material = kEmpty;
  if (rng.below(2) == 0) {
    edit.mask.kind = static_cast<MaskKind>(rng.below(4));
    if (edit.mask.kind == MaskKind::only_material)
      edit.mask.material = static_cast<Material>(rng.below(8));
  }
  return edit;
}

EditDescriptor random_edit_anywhere(SplitMix64& rng) {
  EditDescriptor edit;
  const auto span = [&rng](std::int32_t low, std::int32_t high) {  // extremes are frequent
    const std::uint32_t draw = rng.below(6);
    return draw == 0   ? low
           : draw == 1 ? high
           : draw == 2 ? pick(rng, std::max(low, -100), std::min(high, 100))
                       : pick(rng, low, high);
  };
  const auto id = [&rng] {
    return static_cast<Material>(rng.below(4) == 0 ? 65535 : rng.below(65536));
  };
  switch (rng.below(5)) {
    case 3: {
      const auto inside = [&] { return span(-kWorldLimit, kWorldLimit - 20); };
      edit.shape = Paste{{inside(), inside(), inside()},
                         random_clipboard(rng, 20, rng.below(4) == 0 ? 65536 : 5),
                         random_orientation(rng)};
      break;
    }
    case 0:
      edit.shape =
          SetVoxel{{span(-kWorldLimit, kWorldLimit - 1), span(-kWorldLimit, kWorldLimit - 1),
                    span(-kWorldLimit, kWorldLimit - 1)}};
      break;
    case 1: {
      FillBox fill;
      const auto side = [&](std::int32_t& min, std::int32_t& max) {
        const std::int32_t length = span(1, kEditBoxSideMax);
        min = span(-kWorldLimit, kWorldLimit - length);
        max = min + length;
      };
      side(fill.box.min.x, fill.box.max.x);
      side(fill.box.min.y, fill.box.max.y);
      side(fill.box.min.z, fill.box.max.z);
      edit.shape = fill;
      break;
    }
    case 2: {
      FillStroke stroke;
      const std::int32_t r = span(1, kEditRadiusMax);
      stroke.radius = static_cast<std::uint16_t>(r);
      const auto count = static_cast<std::size_t>(
          rng.below(8) == 0 ? span(2, std::int32_t{kStrokePointsMax}) : 2 + span(0, 3));
      const std::int32_t low = -kWorldLimit + r, high = kWorldLimit - 1 - r;
      const auto step = [&](std::int32_t c) {
        return std::clamp(c + span(-kStrokeStepMax, kStrokeStepMax), low, high);
      };
      stroke.points.push_back({span(low, high), span(low, high), span(low, high)});
      while (stroke.points.size() < count) {
        const VoxelPos& last = stroke.points.back();
        const VoxelPos next{step(last.x), step(last.y), step(last.z)};
        if (next != last) stroke.points.push_back(next);
      }
      edit.shape = stroke;
      break;
    }
    default: {
      FillSphere sphere;
      const std::int32_t r = span(0, kEditRadiusMax);
      sphere.radius = static_cast<std::uint16_t>(r);
      sphere.centre = {span(-kWorldLimit + r, kWorldLimit - 1 - r),
                       span(-kWorldLimit + r, kWorldLimit - 1 - r),
                       span(-kWorldLimit + r, kWorldLimit - 1 - r)};
      edit.shape = sphere;
    }
  }
  if (!std::holds_alternative<Paste>(edit.shape)) edit.material = id();
  edit.mask.kind = static_cast<MaskKind>(rng.below(4));
  if (edit.mask.kind == MaskKind::only_material) edit.mask.material = id();
  return edit;
}

}  // namespace runstone::test
