// MesherJury: all reference meshers before the one oracle that also judges the product. Exposed unit faces
// with material and direction, each covered once by quads that wind outwards; meshers that cull less are held
// to what they do show, face by face.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tests/reference/binary_greedy.hpp"
#include "tests/reference/greedy_mesher.hpp"
#include "tests/reference/grid_rdm.hpp"
#include "tests/reference/naive_greedy_mesher.hpp"
#include "tests/reference/optimal_greedy_mesher.hpp"
#include "tests/reference/run_strip_mesher.hpp"
#include "tests/support/mesh_scene.hpp"

namespace runstone::test {

/// Buffers live as long as the jury: what one scene leaves behind would show in the next.
class MesherJury {
 public:
  /// What is wrong with the first wrong mesh of a scene, and whose it is; nothing if all is well. Binary
  /// greedy is left out where a side is above 64.
  std::string fault(const MeshScene& scene);
  /// The same of those meshers alone that show the exposed faces and no others. Several times quicker.
  std::string fault_of_exposed(const MeshScene& scene);

  /// Of the last scene.
  const std::vector<UnitFace>& exposed() const { return exposed_; }
  std::size_t culled_quads() const { return culled_quads_; }
  std::size_t optimal_quads() const { return optimal_quads_; }
  const ChunkMesh& binary_mesh() const { return mesh_; }

 private:
  std::string fault_of_quads(const char* mesher, const MeshScene& scene,
                             const std::vector<UnitFace>& owed) const;
  /// The same of quads_ against the exposed faces, and what is wrong with how many they are.
  std::string fault_of_merged(const char* mesher, const MeshScene& scene) const;
  std::string fault_of_count(const char* mesher, std::size_t quads) const;
  std::string fault_of_supersets(const MeshScene& scene);

  reference::DenseGrid grid_;
  std::vector<Material> layer_;
  std::vector<Quad> quads_;
  reference::GreedyScratch greedy_;
  reference::NaiveGreedyScratch naive_;
  reference::RunStripScratch strips_;
  reference::OptimalGreedyScratch optimal_;
  reference::GridRdmScratch grid_rdm_;
  reference::BinaryScratch binary_;
  ChunkMesh mesh_;
  std::vector<UnitFace> exposed_;
  std::size_t culled_quads_ = 0, optimal_quads_ = 0, strip_quads_ = 0;
};

}  // namespace runstone::test
