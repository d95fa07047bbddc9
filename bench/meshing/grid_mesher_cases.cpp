#include "bench/meshing/grid_mesher_cases.hpp"

#include <memory>
#include <vector>

#include "bench/meshing/mesher_case_state.hpp"
#include "common/core/assert.hpp"
#include "tests/reference/greedy_mesher.hpp"
#include "tests/reference/grid_rdm.hpp"
#include "tests/reference/monotone_mesher.hpp"
#include "tests/reference/naive_greedy_mesher.hpp"
#include "tests/reference/optimal_greedy_mesher.hpp"
#include "tests/reference/poly2tri_mesher.hpp"
#include "tests/reference/run_strip_mesher.hpp"
#include "tests/reference/simple_mesher.hpp"

namespace runstone::bench {
namespace {

using namespace reference;

template <class Scratch, class Out>
using GridMesher = void (*)(const DenseGrid&, const VisibilityTable&, Scratch&, Out&);

/// The buffers of a grid mesher. The name of the member tells case_over() what the mesher makes.
template <class Out>
struct GridState {
  DenseGrid grid;
  std::vector<Quad> quads;
  std::vector<Quad>& out() { return quads; }
};
template <>
struct GridState<TriangleMesh> {
  DenseGrid grid;
  TriangleMesh triangles;
  TriangleMesh& out() { return triangles; }
};

template <class Scratch, class Out>
MesherCase of_grid(const Volume& volume, const VisibilityTable& visibility,
                   GridMesher<Scratch, Out> mesh) {
  struct State : GridState<Out> {
    Scratch scratch;
  };
  auto state = std::make_shared<State>();
  std::vector<Material> layer;
  decode(volume.scene.chunk, volume.scene.pointers(), layer, state->grid);
  MesherCase out = case_over(state, state->grid.byte_size());
  out.mesh = [state, mesh, &visibility](PhaseTimes&) {
    mesh(state->grid, visibility, state->scratch, state->out());
  };
  return out;
}

struct NoScratch {};

void simple(const DenseGrid& grid, const VisibilityTable& visibility, NoScratch&,
            std::vector<Quad>& out) {
  mesh_simple(grid, visibility, out);
}

template <HiddenFaces hidden>
void run_strips(const DenseGrid& grid, const VisibilityTable& visibility, RunStripScratch& scratch,
                std::vector<Quad>& out) {
  mesh_run_strips(grid, visibility, hidden, scratch, out);
}

}  // namespace

MesherCase grid_mesher_case(std::string_view name, const Volume& volume,
                            const VisibilityTable& visibility) {
  const auto of = [&](auto mesh) { return of_grid(volume, visibility, mesh); };
  if (name == "simple") return of(simple);
  if (name == "greedy") return of(mesh_greedy);
  if (name == "naive_greedy") return of(mesh_naive_greedy);
  if (name == "run_strips") return of(run_strips<HiddenFaces::end_run>);
  if (name == "run_strips_hidden") return of(run_strips<HiddenFaces::run_on>);
  if (name == "optimal_greedy") return of(mesh_optimal_greedy);
  if (name == "monotone") return of(mesh_monotone);
  if (name == "poly2tri") return of(mesh_poly2tri);
  RUNSTONE_ASSERT(name == "grid_rdm");
  return of(mesh_grid_rdm);
}

}  // namespace runstone::bench
