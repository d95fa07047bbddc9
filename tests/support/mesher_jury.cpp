#include "tests/support/mesher_jury.hpp"

#include <algorithm>

#include "common/mesh/reference/culled_mesher.hpp"
#include "common/mesh/reference/rle_rdm.hpp"
#include "common/mesh/reference/simple_mesher.hpp"
#include "common/runs/reorder.hpp"

namespace runstone::test {

using namespace reference;

std::string MesherJury::fault_of_quads(const char* mesher, const MeshScene& scene,
                                       const std::vector<UnitFace>& owed) const {
  const auto difference = quads_difference(quads_, scene.chunk.extent, mesh_materials(), owed);
  return difference ? std::string(mesher) + ": " + *difference : std::string();
}

std::string MesherJury::fault(const MeshScene& scene) {
  std::string wrong = fault_of_exposed(scene);
  return wrong.empty() ? fault_of_supersets(scene) : wrong;
}

std::string MesherJury::fault_of_exposed(const MeshScene& scene) {
  decode(scene.chunk, scene.pointers(), layer_, grid_);
  exposed_ = expected_faces(scene);

  mesh_culled(grid_, mesh_visibility(), quads_);
  if (auto wrong = fault_of_quads("culled", scene, exposed_); !wrong.empty()) return wrong;
  culled_quads_ = quads_.size();

  mesh_grid_rdm(grid_, mesh_visibility(), grid_rdm_, quads_);
  if (auto wrong = fault_of_quads("grid RDM", scene, exposed_); !wrong.empty()) return wrong;
  if (quads_.size() > culled_quads_) return "grid RDM has more quads than the culled mesher";

  mesh_.clear();
  const auto sides = scene.chunk.extent.sides();
  if (*std::max_element(sides.begin(), sides.end()) > kBinarySideMax) return {};
  mesh_binary_greedy(scene.chunk, scene.pointers(), mesh_visibility(), binary_, mesh_);
  if (auto wrong = mesh_difference(mesh_, scene.chunk.extent, mesh_materials(), exposed_)) {
    return "binary greedy: " + *wrong;
  }
  if (mesh_.quad_count() > culled_quads_) return "binary greedy has more quads than the culled mesher";
  return {};
}

std::string MesherJury::fault_of_supersets(const MeshScene& scene) {
  const DenseChunk dense = DenseChunk::of(scene.chunk);
  mesh_simple(grid_, mesh_visibility(), quads_);
  if (auto wrong = fault_of_quads("simple", scene, all_faces(dense, mesh_materials())); !wrong.empty())
    return wrong;

  mesh_rle_rdm(reorder(scene.chunk, AxisOrder::zyx), mesh_visibility(), quads_);
  const std::vector<UnitFace> tail_culled = tail_culled_faces(dense, mesh_materials());
  if (auto wrong = fault_of_quads("RLE RDM", scene, tail_culled); !wrong.empty()) return wrong;
  if (!std::includes(tail_culled.begin(), tail_culled.end(), exposed_.begin(), exposed_.end())) {
    return "RLE RDM hides a face that is exposed";
  }
  return {};
}

}  // namespace runstone::test
