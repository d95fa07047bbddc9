#include "bench/meshing/shapes_case.hpp"

#include <vector>

#include "bench/harness/clocks.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/worlds/village.hpp"
#include "bench/worlds/voxel_world.hpp"
#include "common/mesh/chunk_mesher.hpp"

namespace runstone::bench {
namespace {

/// Meshes all volumes. Returns the ns of a volume on average.
double mesh_volumes(const std::vector<Volume>& volumes, const MeshMaterials& materials,
                    ChunkMeshScratch& scratch, ChunkMesh& mesh, std::size_t& quads,
                    std::size_t& quads_of_shapes) {
  quads = quads_of_shapes = 0;
  const std::uint64_t start = now_ns();
  for (const Volume& volume : volumes) {
    mesh_chunk(volume.scene.chunk, volume.scene.pointers(), MeshBorders{}, materials, scratch,
               mesh);
    quads += mesh.quad_count();
    quads_of_shapes += mesh.shapes.opaque.size() + mesh.shapes.transparent.size();
  }
  return static_cast<double>(now_ns() - start) / static_cast<double>(volumes.size());
}

double share_of_shapes(const std::vector<Volume>& volumes, const ShapeTable& shapes) {
  double all = 0, of_shapes = 0;
  for (const Volume& volume : volumes) {
    const RunList& runs = volume.scene.chunk.runs;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const double length = runs.end(i) - runs.begin(i);
      if (runs.material(i) == kEmpty) continue;
      all += length;
      if (!shapes.is_cube(runs.material(i))) of_shapes += length;
    }
  }
  return of_shapes / all;
}

}  // namespace

ShapesTiming measure_shapes(unsigned repetitions) {
  const std::vector<Visibility> rows = village_visibilities();
  const std::vector<Shape> shapes = village_shapes();
  std::vector<Visibility> cubes = rows;
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    if (!shapes[i].is_cube()) cubes[i] = Visibility::empty;
  }
  const MeshMaterials as_cubes{VisibilityTable(rows)};
  MeshMaterials with_shapes{VisibilityTable(rows)};
  with_shapes.cubes = VisibilityTable(cubes);
  with_shapes.shapes = ShapeTable(shapes);
  const VoxelWorld world{"village", std::make_shared<const VisibilityTable>(rows), std::nullopt,
                         village_column, nullptr};
  const std::vector<Volume> volumes = volumes_in(world, {{0, -2, 0}, {128, 30, 128}}, 32);
  ShapesTiming out;
  out.chunks = volumes.size();
  out.share = share_of_shapes(volumes, with_shapes.shapes);
  ChunkMeshScratch scratch;
  ChunkMesh mesh;
  std::vector<double> cubes_ns, shapes_ns;
  std::size_t none = 0;
  for (unsigned i = 0; i < repetitions + 1; ++i) {
    const double a = mesh_volumes(volumes, as_cubes, scratch, mesh, out.cube_quads, none);
    const double b =
        mesh_volumes(volumes, with_shapes, scratch, mesh, out.quads, out.quads_of_shapes);
    if (i == 0) continue;  // grows the buffers
    cubes_ns.push_back(a);
    shapes_ns.push_back(b);
  }
  out.cubes_ns = median(cubes_ns);
  out.shapes_ns = median(shapes_ns);
  return out;
}

}  // namespace runstone::bench
