#include "common/formats/luanti_block_writer.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/formats/deflate.hpp"
#include "common/formats/luanti_block.hpp"
#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

constexpr std::uint8_t kWrittenVersion = 28;
constexpr std::size_t kWrittenNodes = kLuantiBlockEdge * kLuantiBlockEdge * kLuantiBlockEdge;
constexpr std::uint8_t kDayLight = 15;
constexpr int kDeflateLevel = 6;

void put_u16(Bytes& out, std::size_t number) {
  out.push_back(static_cast<std::uint8_t>(number >> 8));
  out.push_back(static_cast<std::uint8_t>(number));
}

void put(Bytes& out, const Bytes& bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); }

void put_stream(Bytes& out, ByteView plain) {
  put(out, deflate_all(plain, DeflateForm::zlib, kDeflateLevel));
}

}  // namespace

Bytes encode_luanti_block(const RunChunk& voxels, const LuantiNodeOf& node_of) {
  RUNSTONE_ASSERT(voxels.extent == Extent::cube(kLuantiBlockEdge));
  if (voxels.order != AxisOrder::xyz)
    return encode_luanti_block(reorder(voxels, AxisOrder::xyz), node_of);
  std::map<std::string, std::uint16_t> ids;
  std::vector<std::string> names;  // by id
  struct WrittenNode {
    std::uint16_t id = 0;
    std::uint8_t param2 = 0;
  };
  std::map<Material, WrittenNode> written;
  Bytes nodes, param2;
  param2.reserve(kWrittenNodes);
  nodes.reserve(4 * kWrittenNodes);
  for (std::size_t i = 0; i < voxels.runs.size(); ++i) {
    const Material material = voxels.runs.material(i);
    const auto [known, is_new] = written.try_emplace(material);
    if (is_new) {
      const LuantiNode node = node_of(material);
      const auto [named, is_new_name] =
          ids.try_emplace(node.name, static_cast<std::uint16_t>(names.size()));
      if (is_new_name) names.push_back(node.name);
      known->second = {named->second, node.param2};
    }
    const std::uint32_t count = voxels.runs.end(i) - voxels.runs.begin(i);
    for (std::uint32_t node = 0; node < count; ++node) put_u16(nodes, known->second.id);
    param2.insert(param2.end(), count, known->second.param2);
  }
  nodes.insert(nodes.end(), kWrittenNodes, kDayLight);  // param1
  put(nodes, param2);
  // Version, flags, which sides have complete light (all), the bytes of an id and of the
  // parameters.
  Bytes out = {kWrittenVersion, 0, 0xff, 0xff, 2, 2};
  put_stream(out, nodes);
  const Bytes metadata = {0};
  put_stream(out, metadata);
  // Version and number of objects; the time of the block, which is unknown; version of the names.
  put(out, {0, 0, 0, 0xff, 0xff, 0xff, 0xff, 0});
  put_u16(out, names.size());
  for (std::size_t id = 0; id < names.size(); ++id) {
    RUNSTONE_ASSERT(names[id].size() <= UINT16_MAX);
    put_u16(out, id);
    put_u16(out, names[id].size());
    out.insert(out.end(), names[id].begin(), names[id].end());
  }
  put(out, {10, 0, 0});  // bytes of a timer, and their number
  return out;
}

}  // namespace runstone
