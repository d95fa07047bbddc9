// The part of MetaTable that stores the state that belongs to no record: the time of the world, and
// the last places of players.
#include <cmath>
#include <utility>

#include "server/store/meta_table.hpp"
#include "server/store/sql_result.hpp"

namespace runstone {
namespace {

constexpr std::size_t kPlaceBytes = 32 + 3 * 8 + 2 + 2;

bool is_in_world(double coordinate) {
  return std::isfinite(coordinate) && std::abs(coordinate) <= kWorldLimit;
}

}  // namespace

StoreResult<std::optional<SavedClock>> MetaTable::clock() {
  const auto value = find(kClockKey);
  if (!value) return failed(value.error());
  if (!*value) return std::optional<SavedClock>();
  const auto* bytes = std::get_if<Bytes>(&**value);
  if (bytes == nullptr || bytes->size() != 16) return corrupt(kClockKey, "is no clock");
  ByteReader reader(*bytes);
  SavedClock clock;
  clock.record = reader.u64();
  clock.time.day_ms = reader.u32();
  clock.time.rate = reader.u32();
  if (clock.record == 0 || clock.record > kSequenceMax || !is_valid(clock.time))
    return corrupt(kClockKey, "is no clock");
  return std::optional(clock);
}

StoreResult<std::vector<LastPlace>> MetaTable::places() {
  const auto value = find(kPlacesKey);
  if (!value) return failed(value.error());
  std::vector<LastPlace> places;
  if (!*value) return places;
  const auto* bytes = std::get_if<Bytes>(&**value);
  if (bytes == nullptr || bytes->size() % kPlaceBytes != 0 ||
      bytes->size() / kPlaceBytes > kPlayerPlacesMax)
    return corrupt(kPlacesKey, "is no list of places");
  places.resize(bytes->size() / kPlaceBytes);
  ByteReader reader(*bytes);
  for (LastPlace& place : places) {
    for (std::uint8_t& byte : place.key) byte = reader.u8();
    for (double* coordinate : {&place.pose.at.x, &place.pose.at.y, &place.pose.at.z}) {
      *coordinate = reader.f64();
      if (!is_in_world(*coordinate)) return corrupt(kPlacesKey, "has a place outside the world");
    }
    place.pose.yaw = reader.u16();
    place.pose.pitch = static_cast<std::int16_t>(reader.u16());
  }
  return places;
}

StoreResult<void> MetaTable::put_clock(const SavedClock& clock) {
  Bytes bytes;
  ByteWriter writer(bytes);
  writer.u64(clock.record);
  writer.u32(clock.time.day_ms);
  writer.u32(clock.time.rate);
  return put(kClockKey, bytes);
}

StoreResult<void> MetaTable::put_spawn(const WorldPos& spawn) {
  return put("spawn", spawn_bytes(spawn));
}

StoreResult<void> MetaTable::put_places(const std::vector<LastPlace>& places) {
  Bytes bytes;
  bytes.reserve(places.size() * kPlaceBytes);
  ByteWriter writer(bytes);
  for (const LastPlace& place : places) {
    writer.bytes(place.key);
    for (const double coordinate : {place.pose.at.x, place.pose.at.y, place.pose.at.z})
      writer.f64(coordinate);
    writer.u16(place.pose.yaw);
    writer.u16(static_cast<std::uint16_t>(place.pose.pitch));
  }
  return put(kPlacesKey, bytes);
}

}  // namespace runstone
