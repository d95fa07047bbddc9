#include "common/model_writers/model_walk.hpp"

#include <cstddef>

namespace runstone {
namespace {

/// The regions along one axis whose closed range of points holds a point of the build.
struct RegionsAlong {
  std::int32_t first = 0, last = 0;
};

RegionsAlong regions_at(std::int32_t point, std::int32_t count) {
  const std::int32_t above = point / kModelRegionUnits;
  const std::int32_t below = point % kModelRegionUnits == 0 && above > 0 ? above - 1 : above;
  return {below, above < count ? above : count - 1};
}

}  // namespace

ModelWalk::ModelWalk(const WrittenBuild& source, const ModelWriting& writing, PlaneSides sides)
    : build_(source.build),
      counts_(region_counts(source.build)),
      closes_t_junctions_(writing.closes_t_junctions),
      mesher_(source, sides),
      maker_(writing.is_welded, mesher_.shapes()) {
  if (closes_t_junctions_) collect_shared_corners();
}

template <class F>
bool ModelWalk::for_each_quads(F&& f) {
  for (ModelRegionPos at; at.z < counts_.z; ++at.z) {
    for (at.y = 0; at.y < counts_.y; ++at.y) {
      for (at.x = 0; at.x < counts_.x; ++at.x) {
        const std::vector<Quad>& quads = mesher_.quads_of(at);
        if (!quads.empty() && !f(at, quads)) return false;
      }
    }
  }
  return true;
}

std::uint64_t ModelWalk::key_of(ModelRegionPos at) const {
  return static_cast<std::uint64_t>(at.x) +
         static_cast<std::uint64_t>(counts_.x) *
             (static_cast<std::uint64_t>(at.y) +
              static_cast<std::uint64_t>(counts_.y) * static_cast<std::uint64_t>(at.z));
}

/// Calls f(corner) for the corners of all quads but the planes of plants.
template <class F>
void ModelWalk::for_each_corner(const std::vector<Quad>& quads, F&& f) const {
  for (const Quad quad : quads) {
    const ShapeFace* const face = face_of(unpack(quad), mesher_.shapes());
    if (face != nullptr && !face->is_flat()) continue;
    for (const Corner& corner : quad_places(quad, face)) f(corner);
  }
}

/// Gives a corner of a quad to the other regions that it touches.
void ModelWalk::share(ModelRegionPos from, const Corner& at) {
  const auto is_inside = [](int place) { return place % kModelRegionUnits != 0; };
  if (is_inside(at[0]) && is_inside(at[1]) && is_inside(at[2])) return;
  const VoxelPos point = {from.x * kModelRegionUnits + at[0], from.y * kModelRegionUnits + at[1],
                          from.z * kModelRegionUnits + at[2]};
  const RegionsAlong x = regions_at(point.x, counts_.x), y = regions_at(point.y, counts_.y),
                     z = regions_at(point.z, counts_.z);
  const auto place_in = [](std::int32_t place, std::int32_t region) {
    return static_cast<std::uint16_t>(place - region * kModelRegionUnits);
  };
  for (ModelRegionPos to{x.first, y.first, z.first}; to.z <= z.last; ++to.z) {
    for (to.y = y.first; to.y <= y.last; ++to.y) {
      for (to.x = x.first; to.x <= x.last; ++to.x) {
        if (to == from) continue;
        shared_[key_of(to)].push_back(
            {place_in(point.x, to.x), place_in(point.y, to.y), place_in(point.z, to.z)});
      }
    }
  }
}

void ModelWalk::collect_shared_corners() {
  for_each_quads([&](ModelRegionPos at, const std::vector<Quad>& quads) {
    corners_.clear();
    for_each_corner(quads, [&](const Corner& corner) {
      if (corners_.add(corner) == CornerSet::Added::on_lattice) share(at, corner);
    });
    corners_.finish();
    corners_.for_each_fine([&](const Corner& corner) { share(at, corner); });
    return true;
  });
}

void ModelWalk::mark_corners(ModelRegionPos at, const std::vector<Quad>& quads) {
  corners_.clear();
  for_each_corner(quads, [&](const Corner& corner) { corners_.add(corner); });
  if (const auto shared = shared_.find(key_of(at)); shared != shared_.end()) {
    for (const PlaceInRegion& place : shared->second) corners_.add({place[0], place[1], place[2]});
  }
  corners_.finish();
}

Result<void> ModelWalk::check() const {
  if (mesher_.is_complete()) return {};
  return fail(ErrorCode::limit_exceeded,
              "model: 128 x 128 x 128 voxels have too many faces of shapes; use simpler shapes");
}

bool ModelWalk::for_each_region(const RegionSink& sink) {
  return for_each_quads([&](ModelRegionPos at, const std::vector<Quad>& quads) {
    if (closes_t_junctions_) mark_corners(at, quads);
    return sink(
        maker_.make(region_box(build_, at).min, quads, closes_t_junctions_ ? &corners_ : nullptr));
  });
}

}  // namespace runstone
