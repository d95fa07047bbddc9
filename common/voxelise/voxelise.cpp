#include "common/voxelise/voxelise.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

#include "common/voxelise/beam.hpp"
#include "common/voxelise/parts_by_place.hpp"

namespace runstone {
namespace {

/// The solid angles that an open mesh may cost: about a minute of a core.
constexpr std::uint64_t kWindingWorkMax = std::uint64_t{1} << 32;

Result<void> check_options(const VoxeliseOptions& options) {
  if (!options.turn.valid()) return fail(ErrorCode::bad_value, "turn: is not one of the 48");
  if (options.colours_max < 1 || options.colours_max > kModelColoursMax)
    return fail(ErrorCode::bad_value, "colours: must be 1 .. 1,024");
  if (!(options.point_radius >= 0 && options.point_radius <= kPointRadiusMax))
    return fail(ErrorCode::bad_value, "radius of the points: must be 0 .. 64 voxels");
  if (!options.is_solid && options.surface == SurfaceMode::none)
    return fail(ErrorCode::bad_value, "mode: neither solid nor a surface");
  return {};
}

/// The part of the work that one walk over the beams is.
struct WalkProgress {
  const std::function<void(double)>& take;
  double begin = 0, length = 1;  // of the whole work, which is 1

  /// Requires 0 .. 1 of the walk.
  void done(double share) const {
    if (take) take(begin + share * length);
  }
};

/// The beams of a model, in the order of z and y.
class BeamWalk {
 public:
  BeamWalk(const BeamPlan& plan, const ParallelFor& parallel_for, WalkProgress progress)
      : plan_(plan),
        parallel_for_(parallel_for),
        progress_(progress),
        count_(plan.model->is_cloud() ? plan.model->positions.size()
                                      : plan.model->triangles.size()),
        layers_(bands(2)),
        slabs_(count_, layers_,
               [&](std::size_t part) { return range_of(static_cast<std::uint32_t>(part), 2); }) {}

  /// Calls take(BeamResult&&) for each beam, in order, until it fails. Once.
  template <class F>
  Result<void> walk(F&& take) {
    for (std::int32_t slab = 0; slab < layers_; ++slab) {
      if (slab != 0) progress_.done(share_of(slab, 0));
      const auto parts = slabs_.at(slab, [&](std::uint32_t part) { return range_of(part, 2); });
      if (parts.empty() && !needs_all()) continue;
      const std::int32_t rows = bands(1);
      PartsByPlace by_row(parts.size(), rows, [&](std::size_t i) { return range_of(parts[i], 1); });
      const auto row_range = [&](std::uint32_t i) { return range_of(parts[i], 1); };
      std::vector<std::vector<std::uint32_t>> of_rows(static_cast<std::size_t>(rows));
      const auto make = [&](std::size_t row) {
        return make_beam(plan_, static_cast<std::int32_t>(row) * kVoxelSection,
                         slab * kVoxelSection, of_rows[row]);
      };
      std::vector<BeamResult> made;
      for (std::int32_t row = 0; row < rows; ++row) {
        const auto in_row = by_row.at(row, row_range);
        if (in_row.empty() && !needs_all()) continue;
        std::vector<std::uint32_t>& own = of_rows[static_cast<std::size_t>(row)];
        own.reserve(in_row.size());
        for (const std::uint32_t i : in_row) own.push_back(parts[i]);
        if (parallel_for_) continue;
        if (auto taken = take(make(static_cast<std::size_t>(row))); !taken) return taken;
        own = {};
        progress_.done(share_of(slab, row + 1));
      }
      if (!parallel_for_) continue;
      made.resize(of_rows.size());
      parallel_for_(made.size(), [&](std::size_t row) {
        if (!of_rows[row].empty() || needs_all()) made[row] = make(row);
      });
      for (BeamResult& result : made) {
        if (auto taken = take(std::move(result)); !taken) return taken;
      }
    }
    progress_.done(1);
    return {};
  }

 private:
  std::int32_t bands(unsigned axis) const {
    return (plan_.placement->side(axis) + kVoxelSection - 1) / kVoxelSection;
  }
  /// Returns the share of the walk before a row of a slab.
  double share_of(std::int32_t slab, std::int32_t row) const {
    return (slab + static_cast<double>(row) / bands(1)) / layers_;
  }
  /// A beam without a triangle may have voxels inside an open mesh.
  bool needs_all() const { return plan_.winding != nullptr && !plan_.winding->is_zero(); }

  /// Returns the bands of an axis in which a part may set voxels, or change what is inside.
  BandRange range_of(std::uint32_t part, unsigned axis) const {
    const ModelPlacement& placement = *plan_.placement;
    std::int32_t low = 0, high = 0;
    if (plan_.model->is_cloud()) {
      const std::int32_t at = placement.along(axis, plan_.model->positions[part]);
      low = at - static_cast<std::int32_t>(plan_.radius);
      high = at + static_cast<std::int32_t>(plan_.radius);
    } else {
      const auto& corners = plan_.model->triangles[part];
      const auto along = [&](std::uint32_t vertex) {
        return placement.along(axis, plan_.model->positions[vertex]);
      };
      std::tie(low, high) = std::minmax({along(corners[0]), along(corners[1]), along(corners[2])});
    }
    // A voxel is touched from its lower side, too. In a solid the lines to the centres of the next
    // voxels matter, half a voxel beyond the band.
    const std::int32_t beyond = plan_.is_solid ? kVoxelUnit / 2 + 1 : 0;
    constexpr std::int32_t kBandUnits = kVoxelSection * kVoxelUnit;
    const std::int32_t last = bands(axis) - 1;
    return {std::clamp((low - 1 - beyond) / kBandUnits, 0, last),
            std::clamp((high + beyond) / kBandUnits, 0, last)};
  }

  const BeamPlan& plan_;
  const ParallelFor& parallel_for_;
  const WalkProgress progress_;
  std::size_t count_;
  std::int32_t layers_;
  PartsByPlace slabs_;
};

Result<void> check_work(const BeamResult& result, const VoxeliseOptions& options) {
  if (options.should_continue && !options.should_continue())
    return fail(ErrorCode::io_failed, "the work is not wanted any more");
  if (result.holds_too_much) {
    return fail(ErrorCode::limit_exceeded,
                "too many triangles lie one behind another: choose a smaller scale, or a model "
                "with fewer triangles");
  }
  if (!result.is_too_much) return {};
  return fail(
      ErrorCode::limit_exceeded,
      "the mesh has too many open edges for its size: choose a smaller scale, or voxelise its "
      "surface only");
}

/// Returns the colours of the surface of a model that has several.
Result<ColourQuantiser> surface_colours(const BeamPlan& plan, const ParallelFor& parallel_for,
                                        const VoxeliseOptions& options) {
  ColourQuantiser out;
  bool is_empty = true;
  // The second walk makes the voxels.
  const WalkProgress first{options.progress, 0, 0.5};
  auto walked = BeamWalk(plan, parallel_for, first).walk([&](BeamResult&& result) -> Result<void> {
    for (const auto& [colour, count] : result.colours) out.add(colour, count);
    is_empty = is_empty && result.colours.empty();
    return check_work(result, options);
  });
  if (!walked) return failure(walked.error());
  if (is_empty) out.add(plan.colours->fallback());
  out.choose(options.colours_max);
  return out;
}

}  // namespace

Result<Voxelised> voxelise(const Model& model, const VoxeliseOptions& options,
                           const VoxelPieceSink& sink, const ParallelFor& parallel_for) {
  if (auto checked = check_options(options); !checked) return failure(checked.error());
  if (auto valid = validate(model); !valid) return failure(valid.error());
  const auto placement = ModelPlacement::of(model, options.turn, options.scale);
  if (!placement) return failure(placement.error());
  const ModelColours colours(model, *placement);
  Voxelised out;
  out.sides = placement->sides();
  BeamPlan plan{&model, &*placement, &colours};
  std::optional<MeshEdges> edges;
  std::optional<OpenWinding> winding;
  std::optional<OpenWinding> counted;  // of the walk that counts colours
  if (model.is_cloud()) {
    plan.radius = std::lround(options.point_radius * kVoxelUnit);
  } else {
    plan.surface = options.surface;
    plan.is_solid = options.is_solid;
  }
  if (plan.is_solid) {
    auto found = mesh_edges(model, *placement);
    if (!found) return failure(found.error());
    edges = *std::move(found);
    out.closure = edges->closure;
    out.rule = SolidRule::parity;
    if (edges->closure == MeshClosure::open ||
        (options.fills_overlaps && edges->closure == MeshClosure::closed)) {
      out.rule = SolidRule::winding;
      winding.emplace(edges->open, kWindingWorkMax);
      counted.emplace(edges->open, kWindingWorkMax);
      plan.winding = &*counted;
    }
  }
  std::optional<ColourQuantiser> quantiser;
  if (colours.only()) {
    out.colours = {*colours.only()};
  } else {
    auto chosen = surface_colours(plan, parallel_for, options);
    if (!chosen) return failure(chosen.error());
    quantiser = *std::move(chosen);
    out.colours = quantiser->colours();
    plan.quantiser = &*quantiser;
  }
  if (winding) plan.winding = &*winding;
  const double begin = quantiser ? 0.5 : 0;
  const WalkProgress last{options.progress, begin, 1 - begin};
  auto walked = BeamWalk(plan, parallel_for, last).walk([&](BeamResult&& result) -> Result<void> {
    if (auto checked = check_work(result, options); !checked) return checked;
    out.voxels += result.voxels;
    for (VoxelPiece& piece : result.pieces) {
      if (auto taken = sink(std::move(piece)); !taken) return taken;
    }
    return {};
  });
  if (!walked) return failure(walked.error());
  return out;
}

}  // namespace runstone
