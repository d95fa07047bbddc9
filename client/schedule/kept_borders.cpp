#include "client/schedule/kept_borders.hpp"

#include <utility>

namespace runstone {
namespace {

std::size_t bytes_of(const BordersPtr& borders) {
  return borders ? sizeof(ChunkBorders) + borders->byte_size() : 0;
}

}  // namespace

void KeptBorders::keep(const ChunkKey& key, const ShownPtr& of, BordersPtr borders) {
  if (!borders) return erase(key);
  Entry& entry = entries_[key];
  bytes_ += bytes_of(borders);
  bytes_ -= bytes_of(entry.borders);
  entry = {of, std::move(borders)};
}

BordersPtr KeptBorders::find(const ChunkKey& key, const ShownPtr& of) const {
  const auto entry = entries_.find(key);
  if (entry == entries_.end() || !of || entry->second.of.lock() != of) return nullptr;
  return entry->second.borders;
}

void KeptBorders::erase(const ChunkKey& key) {
  const auto entry = entries_.find(key);
  if (entry == entries_.end()) return;
  bytes_ -= bytes_of(entry->second.borders);
  entries_.erase(entry);
}

void KeptBorders::clear() {
  entries_.clear();
  bytes_ = 0;
}

}  // namespace runstone
