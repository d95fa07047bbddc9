// Identities and order: the author of an edit, and its place in the log.
#pragma once
#include <compare>
#include <cstddef>
#include <cstdint>

namespace runstone {

using Material = std::uint16_t;  // index into the material table
inline constexpr Material kEmpty = 0;
inline constexpr std::size_t kMaterialCountMax = 65536;

using TimeUs = std::int64_t;  // microseconds; each use names its clock

using LogId = std::uint32_t;     // number of a log; the only log is 0
using Epoch = std::uint32_t;     // raised by each server start; 0: before the first start
using Sequence = std::uint64_t;  // place in the log, from 1, without gaps; 0: the base
/// Largest sequence and client sequence. Databases store signed integers: a larger value would be
/// read back as a negative number.
inline constexpr Sequence kSequenceMax = 0x7fff'ffff'ffff'ffff;

/// Version of a chunk: the last edit that touched it by geometry, even if no voxel changed. (0, 0)
/// is the base: imported or generated, never edited. Versions are compared lexicographically.
struct Version {
  Epoch epoch = 0;
  Sequence seq = 0;
  friend auto operator<=>(const Version&, const Version&) = default;
};

using AuthorId = std::uint32_t;        // row in `player`; 0: the server
using ClientInstance = std::uint64_t;  // random, drawn once per client process
using ClientSequence = std::uint64_t;  // counts the edits of a client instance, from 1

/// Names one edit as its author sent it, before the world ordered it. An edit that is sent twice is
/// applied once.
struct OperationId {
  AuthorId author = 0;
  ClientInstance instance = 0;
  ClientSequence seq = 0;
  friend auto operator<=>(const OperationId&, const OperationId&) = default;
};

/// The reason why an edit is in the log. Values are frozen: they are stored.
enum class Cause : std::uint8_t {
  player = 0,
  console = 1,
  rollback = 2,
  undo = 3,
  redo = 4,
  import = 5,
  rights = 6,     // a change of rights, by a player or by the console (author 0)
  materials = 7,  // new materials, by the console
  library = 8,    // a change of the library of builds, by a player or by the console (author 0)
  clock = 9,      // the clock of the world is set, by a player or by the console (author 0)
  textures = 10,  // a picture for sides of materials, by the console
  gap = 11        // a record that a repair could not read stood here
};
inline constexpr std::uint8_t kCauseMax = 11;
/// Returns true if the edits with this cause change voxels. The others change rights, materials,
/// textures, the library of builds or the clock, or stand for a lost record.
constexpr bool changes_voxels(Cause cause) {
  return cause != Cause::rights && cause != Cause::materials && cause != Cause::library &&
         cause != Cause::clock && cause != Cause::textures && cause != Cause::gap;
}

using SessionId = std::uint32_t;  // one connection; never reused while the server runs

}  // namespace runstone
