// MesherChecks: checks all reference meshers with the oracle that also checks the product: exposed
// unit faces with material and direction, each covered once by quads that wind outwards. Meshers
// that cull less are compared with the faces that they are to show.
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
#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {

/// The buffers live as long as the object, so that the remains of one scene would show in the next.
class MesherChecks {
 public:
  /// Returns the first mesher with a wrong mesh of the scene and its fault, or an empty text.
  /// Leaves binary greedy out where a side is above 64.
  std::string fault(const MeshScene& scene);
  /// Does the same for the meshers that show the exposed faces and no others. It is several times
  /// as fast.
  std::string fault_of_exposed(const MeshScene& scene);

  /// Results of the last scene.
  const std::vector<UnitFace>& exposed() const { return exposed_; }
  std::size_t culled_quads() const { return culled_quads_; }
  std::size_t optimal_quads() const { return optimal_quads_; }
  const ChunkMesh& binary_mesh() const { return mesh_; }

 private:
  std::string fault_of_quads(const char* mesher, const MeshScene& scene,
                             const std::vector<UnitFace>& owed) const;
  /// Does the same for quads_ and the exposed faces, and also checks the number of quads.
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
