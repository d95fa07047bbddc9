#include "client/display/inspection_control.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>

namespace runstone {

void InspectionControl::set(const InspectionModes& modes) {
  modes_ = modes;
  if (!modes_[InspectionMode::layers]) flashes_.clear();
}

void InspectionControl::set(InspectionMode mode, bool is_on) {
  InspectionModes modes = modes_;
  modes.set(mode, is_on);
  set(modes);
}

void InspectionControl::meshed(const MeshResult& result, TimeUs now_us) {
  if (!modes_[InspectionMode::layers]) return;
  while (!flashes_.empty() && now_us - flashes_.front().at_us > kFlashUs) flashes_.pop_front();
  flashes_.push_back({result.key, result.layers, now_us});
}

bool InspectionControl::is_fading(TimeUs now_us) const {
  // One frame after the end shows the faces without the tint.
  constexpr TimeUs kLastFrameUs = 100'000;
  return !flashes_.empty() && now_us - flashes_.back().at_us < kFlashUs + kLastFrameUs;
}

Inspection InspectionControl::inspection(const Replica& replica, ChunkCoord eye, bool exact,
                                         TimeUs now_us) const {
  Inspection out;
  out.modes = modes_;
  if (modes_[InspectionMode::runs] || modes_[InspectionMode::orders]) add_chunks(replica, eye, out);
  add_flashes(exact, now_us, out);
  return out;
}

void InspectionControl::add_chunks(const Replica& replica, ChunkCoord eye, Inspection& to) const {
  const auto is_near = [eye](ChunkCoord at) {
    return std::abs(at.x - eye.x) <= kRunsRadius && std::abs(at.y - eye.y) <= kRunsRadius &&
           std::abs(at.z - eye.z) <= kRunsRadius;
  };
  for (const ChunkKey& key : replica.confirmed_keys()) {
    const bool shows_runs = modes_[InspectionMode::runs] && is_near(key.at);
    if (!shows_runs && !modes_[InspectionMode::orders]) continue;
    if (ShownPtr shown = replica.shown(key))
      to.chunks.push_back({key, std::move(shown), shows_runs});
  }
}

void InspectionControl::add_flashes(bool exact, TimeUs now_us, Inspection& to) const {
  std::map<ChunkKey, FlashedLayers> by_chunk;
  for (const Flash& flash : flashes_) {
    const TimeUs age_us = now_us - flash.at_us;
    if (!exact && age_us >= kFlashUs) continue;
    FlashedLayers& layers = by_chunk[flash.key];
    layers.key = flash.key;
    layers.layers |= flash.layers;
    layers.strength =
        exact ? 1.0F : 1.0F - static_cast<float>(age_us) / static_cast<float>(kFlashUs);
  }
  for (const auto& [key, layers] : by_chunk) to.flashes.push_back(layers);
}

}  // namespace runstone
