#include "common/formats/minecraft_level.hpp"

#include <cstdint>

#include "common/formats/nbt_file.hpp"
#include "common/formats/nbt_reader.hpp"

namespace runstone {
namespace {

struct LevelSpawn {
  std::optional<std::int32_t> x, y, z;  // SpawnX, SpawnY, SpawnZ
  std::optional<VoxelPos> pos;          // of `spawn`
  bool is_elsewhere = false;            // `spawn` names another dimension
};

void read_spawn(NbtReader& in, LevelSpawn& spawn) {
  NbtEntry entry;
  while (in.next(entry)) {
    if (entry.is("pos", NbtType::int_array)) {
      const NbtInts pos = in.int_array();
      if (pos.size() == 3) spawn.pos = VoxelPos{pos[0], pos[1], pos[2]};
    } else if (entry.is("dimension", NbtType::string)) {
      spawn.is_elsewhere = in.string() != "minecraft:overworld";
    } else {
      in.skip(entry.type);
    }
  }
}

void read_level_data(NbtReader& in, LevelSpawn& spawn) {
  NbtEntry entry;
  while (in.next(entry)) {
    if (entry.is("SpawnX", NbtType::i32)) {
      spawn.x = in.i32();
    } else if (entry.is("SpawnY", NbtType::i32)) {
      spawn.y = in.i32();
    } else if (entry.is("SpawnZ", NbtType::i32)) {
      spawn.z = in.i32();
    } else if (entry.is("spawn", NbtType::compound)) {
      read_spawn(in, spawn);
    } else {
      in.skip(entry.type);
    }
  }
}

bool is_in_world(VoxelPos at) {
  for (const std::int32_t number : {at.x, at.y, at.z}) {
    if (number < -kWorldLimit || number >= kWorldLimit) return false;
  }
  return true;
}

}  // namespace

Result<std::optional<VoxelPos>> read_minecraft_spawn(ByteView level_dat) {
  NbtFileSource source(level_dat);
  NbtReader in(source);
  in.root();
  LevelSpawn spawn;
  NbtEntry entry;
  while (in.next(entry)) {
    if (entry.is("Data", NbtType::compound)) {
      read_level_data(in, spawn);
    } else {
      in.skip(entry.type);
    }
  }
  if (!in.ok()) return failure(in.error());
  std::optional<VoxelPos> out = spawn.is_elsewhere ? std::nullopt : spawn.pos;
  if (!spawn.pos && spawn.x && spawn.y && spawn.z) out = VoxelPos{*spawn.x, *spawn.y, *spawn.z};
  if (out && !is_in_world(*out)) out.reset();
  return out;
}

}  // namespace runstone
