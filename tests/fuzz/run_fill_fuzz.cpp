// The target reads bytes as a small chunk and a script of fills. Runs, areas and digest must equal
// those of the dense oracle.
//   byte 0: axis order; bytes 1-3: sides - 8, modulo 6 (8 .. 13); byte 4: first material
//   then 5 bytes a fill: first (u16), count - 1 (u16), material
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "common/core/bytes.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_chunk.hpp"
#include "tests/support/runs/dense_chunk.hpp"

namespace {

constexpr int kFillsMax = 256;  // bounds the time of one input

void demand(bool holds, const char* what, int step) {
  if (holds) return;
  std::fprintf(stderr, "fill %d: %s\n", step, what);
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace runstone;
  ByteReader in(ByteView(data, size));
  const AxisOrder order = kAxisOrders[in.u8() % kAxisOrderCount];
  Extent extent;
  extent.x = static_cast<std::uint8_t>(8 + in.u8() % 6);
  extent.y = static_cast<std::uint8_t>(8 + in.u8() % 6);
  extent.z = static_cast<std::uint8_t>(8 + in.u8() % 6);
  RunChunk chunk = uniform_chunk(extent, in.u8(), order);
  if (!in.ok()) return 0;
  test::DenseChunk oracle = test::DenseChunk::of(chunk);
  Digest digest = digest_of(chunk);
  for (int step = 0; step < kFillsMax && in.left() >= 5; ++step) {
    const std::uint32_t first = in.u16() % chunk.volume();
    const std::uint32_t count = 1 + in.u16() % (chunk.volume() - first);
    const Material material = in.u8();
    const RunChunk before = chunk;
    EditArea area;
    const bool changed = fill(chunk, first, count, material, &area);
    demand(changed == oracle.fill(order, first, count, material), "verdict differs", step);
    demand(validate(chunk).has_value(), "chunk is invalid", step);
    if (step % 8 == 0) demand(test::DenseChunk::of(chunk) == oracle, "voxels differ", step);
    demand(changed || chunk == before, "runs moved though nothing changed", step);
    if (!changed) continue;
    // The digest is updated from the edit area alone, as in the edit sweep.
    VoxelIndex begin = before.runs.begin(area.first);
    for (std::size_t i = area.first; i < area.first + area.before; ++i) {
      digest = digest - digest_of_span(before, begin, before.runs.end(i), before.runs.material(i));
      begin = before.runs.end(i);
    }
    begin = chunk.runs.begin(area.first);
    for (std::size_t i = area.first; i < area.first + area.after; ++i) {
      digest = digest + digest_of_span(chunk, begin, chunk.runs.end(i), chunk.runs.material(i));
      begin = chunk.runs.end(i);
    }
    demand(digest == digest_of(chunk), "digest does not follow", step);
  }
  demand(test::DenseChunk::of(chunk) == oracle, "voxels differ at the end", -1);
  demand(digest == oracle.digest(), "digest is not the oracle's", -1);
  const auto counts = runs_per_order(chunk);
  for (const AxisOrder other : kAxisOrders) {
    const RunChunk turned = reorder(chunk, other);
    demand(validate(turned).has_value(), "reordered chunk is invalid", -1);
    demand(test::DenseChunk::of(turned) == oracle, "reordered voxels differ", -1);
    demand(turned.runs.size() == counts[static_cast<std::size_t>(other)], "counted runs differ",
           -1);
  }
  return 0;
}
