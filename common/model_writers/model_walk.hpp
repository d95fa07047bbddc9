// ModelWalk: gives the triangles of a build region by region, as often as a writer needs them:
// formats that begin with the counts are written in two passes, so that no pass holds more than one
// region. Thread: one at a time. Memory: the runs, quads and triangles of one region; if
// T-junctions are closed, also 6 bytes for each corner of a quad in a plane between regions.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "common/core/result.hpp"
#include "common/model_writers/corner_set.hpp"
#include "common/model_writers/model_writing.hpp"
#include "common/model_writers/region_mesher.hpp"
#include "common/model_writers/region_model.hpp"

namespace runstone {

/// Takes the triangles of a region, which are valid during the call. Returns false to end the walk.
using RegionSink = std::function<bool(const RegionModel&)>;

class ModelWalk {
 public:
  /// Keeps a reference to the build. Visits the build once if T-junctions are closed.
  ModelWalk(const WrittenBuild& source, const ModelWriting& writing, PlaneSides sides);
  ModelWalk(const ModelWalk&) = delete;
  ModelWalk& operator=(const ModelWalk&) = delete;

  /// Gives each region with faces to the sink: x fastest, then y, then z. Each walk gives the same.
  /// Returns false if the sink did. Cost: O(regions), and that of RegionMesher and
  /// RegionModelMaker.
  bool for_each_region(const RegionSink& sink);
  /// Fails with limit_exceeded if a region that was visited had too many faces of shapes, so that
  /// some are missing.
  Result<void> check() const;

 private:
  using PlaceInRegion = std::array<std::uint16_t, 3>;  // in sixteenths

  /// Calls f(place, quads) for each region with faces until it returns false.
  template <class F>
  bool for_each_quads(F&& f);
  void collect_shared_corners();
  void share(ModelRegionPos from, const Corner& at);
  void mark_corners(ModelRegionPos at, const std::vector<Quad>& quads);
  template <class F>
  void for_each_corner(const std::vector<Quad>& quads, F&& f) const;
  std::uint64_t key_of(ModelRegionPos at) const;

  const Build& build_;
  ModelRegionPos counts_;
  bool closes_t_junctions_;
  RegionMesher mesher_;
  RegionModelMaker maker_;
  CornerSet corners_;
  /// By region: the corners of quads of other regions that lie on its surface.
  std::unordered_map<std::uint64_t, std::vector<PlaceInRegion>> shared_;
};

}  // namespace runstone
