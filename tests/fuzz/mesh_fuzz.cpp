// Mesher against the face oracle on scenes spelled by bytes. Every input is a scene:
//   3 bytes sides (8 + b % 9), 1 byte axis order, 1 byte mask of neighbours,
//   then per chunk (the chunk itself first) a byte of axis order (neighbours only) and (length, material)
//   byte pairs until it is full; when the bytes run out, the rest of a chunk is empty.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

#include "common/runs/run_builder.hpp"
#include "tests/support/mesh_scene.hpp"

namespace {

using namespace runstone;

class Input {
 public:
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool empty() const { return bytes_.empty(); }
  std::uint8_t next() {
    if (bytes_.empty()) return 0;
    const std::uint8_t byte = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return byte;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

AxisOrder read_order(Input& in) { return kAxisOrders[in.next() % kAxisOrderCount]; }

RunChunk read_chunk(Input& in, Extent extent, AxisOrder order) {
  RunBuilder builder(extent, order);
  while (!in.empty() && builder.filled() < extent.volume()) {
    // Lengths above 127 count lines and more, so that a few bytes reach whole layers.
    const std::uint8_t byte = in.next();
    const std::uint32_t length = byte < 128 ? byte + 1u : (byte - 127u) * ordered(extent, order).f;
    const auto material = static_cast<Material>(in.next() % (test::kMeshMaterialCount + 1));
    builder.append(std::min(length, extent.volume() - builder.filled()), material);
  }
  builder.append_to(extent.volume(), kEmpty);
  return builder.finish();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input in({data, size});
  const auto side = [&] { return static_cast<std::uint8_t>(kSideMin + in.next() % 9); };
  const std::uint8_t x = side();
  const std::uint8_t y = side();
  const Extent extent{x, y, side()};
  const AxisOrder order = read_order(in);
  const std::uint8_t mask = in.next();
  test::MeshScene scene{read_chunk(in, extent, order), {}};
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    if ((mask >> d & 1) == 0) continue;
    const AxisOrder theirs = read_order(in);
    scene.neighbours[d] = read_chunk(in, extent, theirs);
  }
  if (const auto difference = test::scene_difference(scene, test::mesh_of(scene))) {
    std::fprintf(stderr, "%s\n", difference->c_str());
    std::abort();
  }
  return 0;
}
