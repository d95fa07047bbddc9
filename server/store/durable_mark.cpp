#include "server/store/durable_mark.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <utility>

#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {
namespace {

constexpr std::uint64_t kSlots = 2;
constexpr std::uint64_t kSlotDistance = 4096;
constexpr std::size_t kSlotBytes = kWorldIdBytes + 24;

std::uint64_t slot_checksum(const WorldId& world, const DurableState& state) {
  return static_cast<std::uint64_t>(RowChecksum("durable")
                                        .blob(world)
                                        .integer(static_cast<std::int64_t>(state.seq))
                                        .integer(std::int64_t{state.epoch})
                                        .integer(std::int64_t{state.author_max})
                                        .value());
}

Bytes slot_bytes(const WorldId& world, const DurableState& state) {
  Bytes bytes;
  ByteWriter out(bytes);
  out.bytes(world);
  out.u64(state.seq);
  out.u32(state.epoch);
  out.u32(state.author_max);
  out.u64(slot_checksum(world, state));
  return bytes;
}

}  // namespace

DurableMark::~DurableMark() { static_cast<void>(sync().has_value()); }

StoreResult<std::optional<DurableState>> DurableMark::read() {
  newest_.reset();
  const auto there = sql::file_exists(file_, vfs_);
  if (!there) return failed(there.error());
  if (!*there) return newest_;
  auto file = sql::VfsFile::open(file_, sql::VfsFile::Mode::read, vfs_);
  if (!file) return failed(file.error());
  bool is_any_damaged = false;
  for (std::uint64_t slot = 0; slot < kSlots; ++slot) {
    std::array<std::uint8_t, kSlotBytes> bytes{};
    if (const auto read = file->read(slot * kSlotDistance, bytes); !read)
      return failed(read.error());
    // A slot that was never written has zeros.
    if (std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t byte) { return byte == 0; }))
      continue;
    ByteReader in(bytes);
    WorldId world;
    const ByteView id = in.bytes(world.size());
    std::copy(id.begin(), id.end(), world.begin());
    DurableState state;
    state.seq = in.u64();
    state.epoch = in.u32();
    state.author_max = in.u32();
    if (in.u64() != slot_checksum(world, state)) {
      is_any_damaged = true;
    } else if (world == world_ && (!newest_ || state > *newest_)) {
      newest_ = state;
      next_slot_ = (slot + 1) % kSlots;
    }
  }
  if (!newest_ && is_any_damaged) {
    return failure(
        StoreError{StoreError::Kind::corrupt, file_, "",
                   "is damaged, so it is not known whether the log still has all of its edits"});
  }
  return newest_;
}

StoreResult<void> DurableMark::write(const DurableState& state) {
  if (newest_ && state <= *newest_) return {};
  if (!open_) {
    auto opened = sql::VfsFile::open(file_, sql::VfsFile::Mode::write, vfs_);
    if (!opened) return failed(opened.error());
    open_ = *std::move(opened);
    // As the other files of a world. SQLite makes a file that everybody can read.
    static_cast<void>(::chmod(file_.c_str(), S_IRUSR | S_IWUSR));
  }
  const Bytes bytes = slot_bytes(world_, state);
  if (const auto written = open_->write(next_slot_ * kSlotDistance, bytes); !written)
    return failed(written.error());
  newest_ = state;
  next_slot_ = (next_slot_ + 1) % kSlots;
  is_synced_ = false;
  return {};
}

StoreResult<void> DurableMark::sync() {
  if (is_synced_) return {};
  if (const auto synced = open_->sync(); !synced) return failed(synced.error());
  is_synced_ = true;
  return {};
}

}  // namespace runstone
