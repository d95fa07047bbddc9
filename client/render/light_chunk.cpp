#include "client/render/light_chunk.hpp"

#include <algorithm>
#include <utility>

#include "common/runs/run_builder.hpp"

namespace runstone {

LightChunk light_chunk(const RunChunk& chunk, const LightCodes& codes) {
  RunBuilder builder(chunk.extent, chunk.order);
  for (std::size_t run = 0; run < chunk.runs.size(); ++run) {
    const Material id = chunk.runs.material(run);
    builder.append_to(chunk.runs.end(run),
                      id < codes.size() ? codes[id] : light_code(LightPass::opaque, 0, 0, 0));
  }
  LightChunk out{builder.finish(), {}};
  if (out.codes.is_uniform()) return out;
  const std::size_t edge = chunk.extent.x;
  out.tops.assign(edge * chunk.extent.z, 0);
  for_each_light_box(out.codes, [&](const std::array<int, 3>& first, const std::array<int, 3>& last,
                                    LightCode code) {
    if (pass_of(code) != LightPass::opaque) return;
    const auto top = static_cast<std::uint8_t>(last[1]);
    for (int z = first[2]; z < last[2]; ++z) {
      for (int x = first[0]; x < last[0]; ++x) {
        std::uint8_t& highest =
            out.tops[static_cast<std::size_t>(x) + edge * static_cast<std::size_t>(z)];
        highest = std::max(highest, top);
      }
    }
  });
  return out;
}

int LightChunk::top(int x, int z) const {
  if (tops.empty())
    return pass_of(codes.runs.material(0)) == LightPass::opaque ? codes.extent.y : 0;
  return tops[static_cast<std::size_t>(x) +
              static_cast<std::size_t>(codes.extent.x) * static_cast<std::size_t>(z)];
}

}  // namespace runstone
