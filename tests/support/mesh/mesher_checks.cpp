#include "tests/support/mesh/mesher_checks.hpp"

#include <algorithm>

#include "common/runs/reorder.hpp"
#include "tests/reference/culled_mesher.hpp"
#include "tests/reference/rle_rdm.hpp"
#include "tests/reference/simple_mesher.hpp"

namespace runstone::test {

using namespace reference;

std::string MesherChecks::fault_of_quads(const char* mesher, const MeshScene& scene,
                                         const std::vector<UnitFace>& owed) const {
  const auto difference = quads_difference(quads_, scene.chunk.extent, mesh_materials(), owed);
  return difference ? std::string(mesher) + ": " + *difference : std::string();
}

std::string MesherChecks::fault_of_count(const char* mesher, std::size_t quads) const {
  if (quads > culled_quads_) return std::string(mesher) + " has more quads than there are faces";
  if (quads < optimal_quads_) return std::string(mesher) + " has fewer quads than the optimum";
  return {};
}

std::string MesherChecks::fault_of_merged(const char* mesher, const MeshScene& scene) const {
  std::string wrong = fault_of_quads(mesher, scene, exposed_);
  return wrong.empty() ? fault_of_count(mesher, quads_.size()) : wrong;
}

std::string MesherChecks::fault(const MeshScene& scene) {
  std::string wrong = fault_of_exposed(scene);
  return wrong.empty() ? fault_of_supersets(scene) : wrong;
}

std::string MesherChecks::fault_of_exposed(const MeshScene& scene) {
  decode(scene.chunk, scene.pointers(), layer_, grid_);
  exposed_ = expected_faces(scene);

  mesh_culled(grid_, mesh_visibility(), quads_);
  if (auto wrong = fault_of_quads("culled", scene, exposed_); !wrong.empty()) return wrong;
  culled_quads_ = quads_.size();

  optimal_quads_ = 0;
  mesh_optimal_greedy(grid_, mesh_visibility(), optimal_, quads_);
  if (auto wrong = fault_of_merged("optimal greedy", scene); !wrong.empty()) return wrong;
  optimal_quads_ = quads_.size();

  mesh_greedy(grid_, mesh_visibility(), greedy_, quads_);
  if (auto wrong = fault_of_merged("greedy", scene); !wrong.empty()) return wrong;
  mesh_naive_greedy(grid_, mesh_visibility(), naive_, quads_);
  if (auto wrong = fault_of_merged("naive greedy", scene); !wrong.empty()) return wrong;
  mesh_run_strips(grid_, mesh_visibility(), HiddenFaces::end_run, strips_, quads_);
  if (auto wrong = fault_of_merged("run strips", scene); !wrong.empty()) return wrong;
  strip_quads_ = quads_.size();
  mesh_grid_rdm(grid_, mesh_visibility(), grid_rdm_, quads_);
  if (auto wrong = fault_of_merged("grid RDM", scene); !wrong.empty()) return wrong;

  mesh_.clear();
  const auto sides = scene.chunk.extent.sides();
  if (*std::max_element(sides.begin(), sides.end()) > kBinarySideMax) return {};
  mesh_binary_greedy(scene.chunk, scene.pointers(), mesh_visibility(), binary_, mesh_);
  if (auto wrong = mesh_difference(mesh_, scene.chunk.extent, mesh_materials(), exposed_)) {
    return "binary greedy: " + *wrong;
  }
  return fault_of_count("binary greedy", mesh_.quad_count());
}

std::string MesherChecks::fault_of_supersets(const MeshScene& scene) {
  const DenseChunk dense = DenseChunk::of(scene.chunk);
  const std::vector<UnitFace> all = all_faces(dense, mesh_materials());
  mesh_simple(grid_, mesh_visibility(), quads_);
  if (auto wrong = fault_of_quads("simple", scene, all); !wrong.empty()) return wrong;

  mesh_run_strips(grid_, mesh_visibility(), HiddenFaces::run_on, strips_, quads_);
  const std::vector<UnitFace> run_on = run_on_faces(dense, exposed_);
  if (auto wrong = fault_of_quads("run strips over hidden faces", scene, run_on); !wrong.empty())
    return wrong;
  if (!std::includes(run_on.begin(), run_on.end(), exposed_.begin(), exposed_.end()) ||
      !std::includes(all.begin(), all.end(), run_on.begin(), run_on.end())) {
    return "run strips over hidden faces miss an exposed face, or show one that no voxel has";
  }
  if (quads_.size() > strip_quads_)
    return "run strips have fewer quads where hidden faces end them";

  mesh_rle_rdm(reorder(scene.chunk, AxisOrder::zyx), mesh_visibility(), quads_);
  const std::vector<UnitFace> tail_culled = tail_culled_faces(dense, mesh_materials());
  if (auto wrong = fault_of_quads("RLE RDM", scene, tail_culled); !wrong.empty()) return wrong;
  if (!std::includes(tail_culled.begin(), tail_culled.end(), exposed_.begin(), exposed_.end())) {
    return "RLE RDM hides a face that is exposed";
  }
  return {};
}

}  // namespace runstone::test
