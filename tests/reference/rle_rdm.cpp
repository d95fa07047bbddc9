#include "tests/reference/rle_rdm.hpp"

#include <algorithm>

#include "common/core/assert.hpp"
#include "tests/reference/voxel_faces.hpp"

namespace runstone::reference {

void mesh_rle_rdm(const RunChunk& chunk, const VisibilityTable& visibility,
                  std::vector<Quad>& out) {
  RUNSTONE_ASSERT(chunk.order == AxisOrder::zyx);
  out.clear();
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  OrderedPos at{0, 0, 0};  // advances with the runs
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < chunk.runs.size(); ++i) {
    const Run run = chunk.runs[i];
    const bool drawn = visibility[run.material] != Visibility::empty;
    for (std::uint32_t done = 0; begin < run.end;) {
      const std::uint32_t length = std::min(run.end - begin, e.f - at.f);
      if (drawn) {
        const LocalPos first = from_ordered(at, chunk.order);
        const LocalPos last = from_ordered({at.f + length - 1, at.m, at.s}, chunk.order);
        out.push_back(strip_quad(first, Direction::pos_x, run.material, Axis::z, length));
        out.push_back(strip_quad(first, Direction::pos_y, run.material, Axis::z, length));
        out.push_back(face_quad(last, Direction::pos_z, run.material));
        out.push_back(face_quad(first, Direction::neg_z, run.material));
        if (done < e.layer())
          out.push_back(strip_quad(first, Direction::neg_x, run.material, Axis::z, length));
        if (at.m == 0 || done < e.f) {
          out.push_back(strip_quad(first, Direction::neg_y, run.material, Axis::z, length));
        }
      }
      done += length;
      begin += length;
      at.f += length;
      if (at.f == e.f) {
        at.f = 0;
        if (++at.m == e.m) {
          at.m = 0;
          ++at.s;
        }
      }
    }
  }
}

}  // namespace runstone::reference
